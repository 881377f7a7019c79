// SPDX-License-Identifier: MIT
#include "server/control_channel.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "server/state_json.h"

namespace dynslam {
namespace {

using nlohmann::json;

constexpr std::uint16_t kNotUnderstood = 1003, kTooMuch = 1008;
constexpr std::chrono::milliseconds kLookEvery{100};
constexpr std::size_t kMostUnderWay = 32;

double tenths(Duration d) { return std::round(1e4 * to_seconds(d)) / 10.0; }

}  // namespace

ControlChannel::ControlChannel(Wheel& wheel, Ports& ports, const Clock& clock, EventCounters& events,
                               ControlClient client, StillAllowed still_allowed)
    : WatchChannel(std::move(still_allowed)),
      wheel_(wheel),
      ports_(ports),
      clock_(clock),
      events_(events),
      client_(std::move(client)),
      number_(wheel.enter()) {}

ControlChannel::~ControlChannel() { wheel_.leave(number_); }

std::optional<WsClosing> ControlChannel::take(const WsMessage& message, SteadyTime now) {
  if (message.opcode != WsOpcode::kText) return WsClosing{kNotUnderstood, "messages here are text"};
  const auto said = parse_control(message.payload);
  if (!rate_.pass(Time(now.time_since_epoch()))) {
    events_.add("server.control_messages_dropped");
    if (std::holds_alternative<StopWish>(said)) ports_.stops.push(client_.name);  // counts all the same
    return ++dropped_ > kMostDropped ? std::optional(WsClosing{kTooMuch, "too many messages"}) : std::nullopt;
  }
  wheel_.touch(number_, now);
  std::visit([&](const auto& m) { take_one(m, now); }, said);
  return std::nullopt;
}

void ControlChannel::take_one(const DriveWish& wish, SteadyTime) {
  if (last_seq_ && wish.seq <= *last_seq_) {
    events_.add("server.control_out_of_order");
    return;
  }
  last_seq_ = wish.seq;
  const auto sent = wheel_.drive(number_, wish.twist);
  if (!sent) return;  // the page beats its heart before it has the wheel
  if (under_way_.size() == kMostUnderWay) under_way_.pop_front();
  under_way_.push_back({sent->seq, wish.seq});
  json ack = {{"ack", wish.seq}, {"t_s", seconds_of(sent->heard)}, {"driven", nullptr}};
  const auto answered = wheel_.answered();
  while (answered && !under_way_.empty() && under_way_.front().robot_seq <= answered->seq) {
    if (under_way_.front().robot_seq == answered->seq)
      ack["driven"] = {{"seq", under_way_.front().client_seq}, {"ms", tenths(answered->delay)}};
    under_way_.pop_front();
  }
  const auto drive = ports_.drive.get().value;
  ack["motion"] = drive ? to_string(drive->verdict.motion) : "stop";
  ack["reason"] = drive ? drive->verdict.reason : "the robot is not ready yet";
  reply(text_of(ack));
}

void ControlChannel::take_one(LeaseWish wish, SteadyTime now) {
  if (wish == LeaseWish::kRelease) {
    wheel_.release(number_);
  } else if (!client_.may_drive) {
    refuse("only a driver may take the wheel");
  } else if (!wheel_.acquire(number_, client_.name, wish == LeaseWish::kTakeOver, now, client_.id)) {
    refuse("somebody else has the wheel; ask him, or take it over");
  }
  tell_holder();
}

void ControlChannel::take_one(StopWish, SteadyTime) {
  ports_.stops.push(client_.name);
  reply(text_of({{"stopped", true}, {"t_s", now_s()}}));
}

void ControlChannel::take_one(const BadMessage& bad, SteadyTime) {
  events_.add("server.control_messages_refused");
  refuse(bad.why);
}

void ControlChannel::refuse(const std::string& why) {
  reply(text_of({{"error", why}, {"errors", ++errors_}, {"t_s", now_s()}}));
}

/// A client that does not listen loses what was said to it first.
void ControlChannel::reply(std::string text) {
  replies_.push_back(std::move(text));
  if (replies_.size() <= kMostReplies) return;
  replies_.pop_front();
  events_.add("server.control_replies_dropped");
}

void ControlChannel::tell_holder() {
  const Wheel::Holder holder = wheel_.holder(number_);
  if (told_ == holder) return;
  told_ = holder;
  json wheel = {{"mine", holder.mine}, {"driver", nullptr}};
  if (holder.driver) wheel["driver"] = *holder.driver;
  reply(text_of({{"wheel", wheel}, {"t_s", now_s()}}));
}

std::optional<WsMessage> ControlChannel::next(SteadyTime now) {
  if (now >= look_at_) {
    look_at_ = now + kLookEvery;
    tell_holder();
  }
  if (replies_.empty()) return std::nullopt;
  WsMessage message{WsOpcode::kText, std::move(replies_.front())};
  replies_.pop_front();
  return message;
}

}  // namespace dynslam
