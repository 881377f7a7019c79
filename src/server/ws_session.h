// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <string>

#include "server/channel.h"

namespace dynslam {

/// Serves one WebSocket whose handshake is done: reads and writes it, in the one thread that calls run().
/// Never waits for the client to take something for longer than kPatience, keeps at most one message to send
/// and one to read, and closes on a client that is silent to pings.
///
/// civetweb, which accepted the socket, would take messages of up to 2 GiB into memory and wait for the rest
/// of one for ever; so its frames are read here.
class WsSession {
 public:
  static constexpr std::chrono::seconds kPatience{5};
  static constexpr std::chrono::seconds kPingAfter{5};
  static constexpr std::chrono::seconds kSilentFor{15};

  /// `socket` stays the caller's.
  WsSession(int socket, Channel& channel);

  /// Until the client is gone, does what it may not, or `stopping`. Throws what the channel throws.
  void run(const std::atomic<bool>& stopping);
  /// Ends the connection. What the client is still saying is heard for a moment, or the system would throw
  /// away what was said to it last.
  void farewell();

 private:
  using SteadyTime = Channel::SteadyTime;

  void fill(SteadyTime now);
  bool flush(SteadyTime now);
  bool receive(SteadyTime now);
  bool handle(const WsMessage& message, SteadyTime now);
  SteadyTime wake_at() const;
  bool close(const WsClosing& closing);

  int socket_;
  Channel& channel_;
  WsFrameReader reader_;
  std::string out_;
  std::size_t sent_ = 0;
  std::string pong_;  ///< the newest ping's, to be answered
  bool pong_due_ = false;
  SteadyTime sent_at_, heard_at_, pinged_at_;
};

}  // namespace dynslam
