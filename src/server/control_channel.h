// SPDX-License-Identifier: MIT
#pragma once

#include <deque>
#include <functional>
#include <string>

#include "server/channel.h"
#include "server/control_message.h"
#include "server/event_counters.h"
#include "server/rate_limit.h"
#include "server/watch_channels.h"
#include "server/wheel.h"

namespace dynslam {

/// Who is at the other end of `control`.
struct ControlClient {
  std::string name;
  bool may_drive = false;
  std::string id = {};  ///< of what let him in
};

/// `control`: commands up, what became of them down. When it is destroyed the client is gone.
class ControlChannel : public WatchChannel {
 public:
  static constexpr double kMostPerSecond = 60.0, kBurst = 60.0;
  static constexpr int kMostDropped = 500;
  static constexpr std::size_t kMostReplies = 64;

  ControlChannel(Wheel& wheel, Ports& ports, const Clock& clock, EventCounters& events, ControlClient client,
                 StillAllowed still_allowed);
  ~ControlChannel() override;
  ControlChannel(const ControlChannel&) = delete;
  ControlChannel& operator=(const ControlChannel&) = delete;

  std::size_t longest_message() const override { return kLongestControlMessage; }
  std::optional<WsClosing> take(const WsMessage& message, SteadyTime now) override;
  std::optional<WsMessage> next(SteadyTime now) override;
  SteadyTime due() const override { return look_at_; }

 private:
  void take_one(const DriveWish& wish, SteadyTime now);
  void take_one(LeaseWish wish, SteadyTime now);
  void take_one(StopWish, SteadyTime now);
  void take_one(const BadMessage& bad, SteadyTime now);
  void refuse(const std::string& why);
  void reply(std::string text);
  void tell_holder();
  double now_s() const { return seconds_of(clock_.now()); }

  Wheel& wheel_;
  Ports& ports_;
  const Clock& clock_;
  EventCounters& events_;
  ControlClient client_;
  Wheel::Client number_;
  RateLimit rate_{kMostPerSecond, kBurst};
  int dropped_ = 0;
  std::uint64_t errors_ = 0;
  std::optional<std::uint64_t> last_seq_;
  struct UnderWay {
    std::uint64_t robot_seq, client_seq;
  };
  std::deque<UnderWay> under_way_;  ///< not answered by the motors yet; bounded
  std::deque<std::string> replies_;
  std::optional<Wheel::Holder> told_;
  SteadyTime look_at_;
};

}  // namespace dynslam
