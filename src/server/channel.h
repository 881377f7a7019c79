// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "pipe/clock.h"
#include "server/ws_frame.h"

namespace dynslam {

/// What goes on over one WebSocket, without the socket: one client's side of `control`, `state`, `map` or
/// `video`. Called by the one thread that serves the socket; destroyed when that is closed.
class Channel {
 public:
  using SteadyTime = Clock::SteadyTime;

  virtual ~Channel() = default;
  /// The longest message that a client may send.
  virtual std::size_t longest_message() const = 0;
  /// What the client said, text or binary. Returns why the socket is to be closed, if it is.
  virtual std::optional<WsClosing> take(const WsMessage& message, SteadyTime now) = 0;
  /// What to tell the client now; asked again until there is nothing. Only asked once all that came before
  /// has gone out, so that a slow client gets the newest and never a queue.
  virtual std::optional<WsMessage> next(SteadyTime now) = 0;
  /// When to ask next() again though the client said nothing.
  virtual SteadyTime due() const = 0;
  /// Why the socket is to be closed though the client did nothing wrong: it may not be here any more.
  virtual std::optional<WsClosing> ended(SteadyTime) { return std::nullopt; }
};

}  // namespace dynslam
