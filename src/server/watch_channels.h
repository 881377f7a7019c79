// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>

#include "server/channel.h"
#include "server/feeds.h"

namespace dynslam {

/// Says why a client may not be here any more; empty while it may.
using StillAllowed = std::function<std::string()>;

/// A channel for those who look on: asks now and then whether they still may.
class WatchChannel : public Channel {
 public:
  explicit WatchChannel(StillAllowed still_allowed) : still_allowed_(std::move(still_allowed)) {}
  std::optional<WsClosing> ended(SteadyTime now) override;

 private:
  StillAllowed still_allowed_;
  SteadyTime ask_at_;
};

/// `state`: all that a person wants to see, with each scan.
class StateChannel : public WatchChannel {
 public:
  StateChannel(StateFeed& feed, StillAllowed still_allowed)
      : WatchChannel(std::move(still_allowed)), feed_(feed) {}

  std::size_t longest_message() const override { return 64; }
  std::optional<WsClosing> take(const WsMessage& message, SteadyTime now) override;
  std::optional<WsMessage> next(SteadyTime now) override;
  SteadyTime due() const override { return std::min(due_, look_at_); }

 private:
  StateFeed& feed_;
  std::uint64_t scan_ = 0;  ///< the newest that was told of
  SteadyTime due_, may_, look_at_;
};

/// `map`: what has changed, once the client said what it has.
class MapChannel : public WatchChannel {
 public:
  static constexpr std::size_t kChunksATurn = 24;
  static constexpr std::chrono::milliseconds kEvery{100};

  MapChannel(MapFeed& feed, StillAllowed still_allowed)
      : WatchChannel(std::move(still_allowed)), feed_(feed) {}

  std::size_t longest_message() const override { return kLongestMapHave; }
  std::optional<WsClosing> take(const WsMessage& message, SteadyTime now) override;
  std::optional<WsMessage> next(SteadyTime now) override;
  SteadyTime due() const override { return due_; }

 private:
  MapFeed& feed_;
  std::optional<MapDelivery> delivery_;  ///< none: the client has not said what it has
  bool told_all_ = false;
  SteadyTime due_;
};

/// `video`: the newest picture, when the client has shown the one before. The camera runs while there is one
/// of these.
class VideoChannel : public WatchChannel {
 public:
  static constexpr std::uint32_t kOnTheWay = 2;  ///< pictures that are not acknowledged
  static constexpr std::chrono::milliseconds kLookEvery{5};
  static constexpr std::chrono::seconds kPatience{10};

  VideoChannel(Ports& ports, StillAllowed still_allowed);
  ~VideoChannel() override { --ports_.watchers; }
  VideoChannel(const VideoChannel&) = delete;
  VideoChannel& operator=(const VideoChannel&) = delete;

  std::size_t longest_message() const override { return 64; }
  std::optional<WsClosing> take(const WsMessage& message, SteadyTime now) override;
  std::optional<WsMessage> next(SteadyTime now) override;
  SteadyTime due() const override { return due_; }
  std::optional<WsClosing> ended(SteadyTime now) override;

 private:
  Ports& ports_;
  std::uint64_t seen_;  ///< version of the newest picture that was sent, or is too old to be
  std::uint32_t sent_ = 0, shown_ = 0;
  SteadyTime shown_at_, due_;
};

}  // namespace dynslam
