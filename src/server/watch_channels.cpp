// SPDX-License-Identifier: MIT
#include "server/watch_channels.h"

#include <algorithm>

#include "server/video_message.h"

namespace dynslam {
namespace {

constexpr std::chrono::seconds kAskEvery{1};
constexpr std::chrono::milliseconds kLookForScanEvery{10}, kScanMayBeLate{10};
constexpr std::uint16_t kNotUnderstood = 1003, kNotAllowed = 1008;

}  // namespace

std::optional<WsClosing> WatchChannel::ended(SteadyTime now) {
  if (!still_allowed_ || now < ask_at_) return std::nullopt;
  ask_at_ = now + kAskEvery;
  const std::string why = still_allowed_();
  return why.empty() ? std::nullopt : std::optional(WsClosing{kNotAllowed, why});
}

std::optional<WsClosing> StateChannel::take(const WsMessage&, SteadyTime) {
  return WsClosing{kNotUnderstood, "nothing is said on this socket"};
}

/// A scan is not kept waiting for the next turn; scans that come ten times a second, more or less, set the
/// pace.
std::optional<WsMessage> StateChannel::next(SteadyTime now) {
  look_at_ = now + kLookForScanEvery;
  const std::uint64_t scan = feed_.scan();
  if (now < due_ && (scan == scan_ || now < may_)) return std::nullopt;
  scan_ = scan;
  due_ = now + StateFeed::kEvery + kScanMayBeLate;
  may_ = now + StateFeed::kEvery / 2;
  return WsMessage{WsOpcode::kText, feed_.get(now)};
}

std::optional<WsClosing> MapChannel::take(const WsMessage& message, SteadyTime now) {
  const auto have = message.opcode == WsOpcode::kBinary ? parse_map_have(message.payload) : std::nullopt;
  if (!have) return WsClosing{kNotUnderstood, "not what a client of the map says"};
  if (delivery_) return WsClosing{kNotUnderstood, "said twice what the client has"};
  delivery_.emplace(have->map_id == feed_.map_id() ? have->chunks : ChunkVersions());
  due_ = now;
  return std::nullopt;
}

std::optional<WsMessage> MapChannel::next(SteadyTime now) {
  if (now < due_) return std::nullopt;
  due_ = now + kEvery;
  if (!delivery_) return std::nullopt;
  auto bytes = feed_.next(*delivery_, kChunksATurn, told_all_);
  if (!bytes) return std::nullopt;
  told_all_ = delivery_->round_done();
  return WsMessage{WsOpcode::kBinary, std::move(*bytes)};
}

VideoChannel::VideoChannel(Ports& ports, StillAllowed still_allowed)
    : WatchChannel(std::move(still_allowed)),
      ports_(ports),
      seen_(ports.video.get().version),
      shown_at_(std::chrono::steady_clock::now()) {
  ++ports_.watchers;
}

std::optional<WsClosing> VideoChannel::take(const WsMessage& message, SteadyTime now) {
  const auto number = message.opcode == WsOpcode::kText ? parse_video_ack(message.payload) : std::nullopt;
  if (!number || *number > sent_) return WsClosing{kNotUnderstood, "not an acknowledgement of a picture"};
  shown_ = std::max(shown_, *number);
  shown_at_ = now;
  return std::nullopt;
}

std::optional<WsMessage> VideoChannel::next(SteadyTime now) {
  if (now < due_) return std::nullopt;
  due_ = now + kLookEvery;
  if (sent_ - shown_ >= kOnTheWay) return std::nullopt;
  const auto item = ports_.video.get();
  if (!item.value || item.version == seen_) return std::nullopt;
  seen_ = item.version;
  if (sent_ == shown_) shown_at_ = now;
  return WsMessage{WsOpcode::kBinary, to_bytes(*item.value, ++sent_)};
}

std::optional<WsClosing> VideoChannel::ended(SteadyTime now) {
  if (sent_ > shown_ && now - shown_at_ > kPatience) return WsClosing{1000, "the pictures are not shown"};
  return WatchChannel::ended(now);
}

}  // namespace dynslam
