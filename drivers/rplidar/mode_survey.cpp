// SPDX-License-Identifier: MIT
#include "drivers/rplidar/mode_survey.h"

namespace dynslam::rplidar {
namespace {

constexpr std::array<ConfItem, 4> kModeItems{ConfItem::kSampleTime, ConfItem::kMaxRange,
                                             ConfItem::kAnswerType, ConfItem::kModeName};
constexpr std::uint16_t kNoMode = 0xFFFF;

std::optional<ByteView> ask_conf(DeviceTalk& talk, ConfItem item, std::optional<std::uint16_t> mode,
                                 Time until) {
  DeviceTalk::Question question{conf_request(item, mode), AnswerType::kConf};
  question.accepts = [item](ByteView answer) { return parse_conf(answer, item).has_value(); };
  const auto payload = talk.ask(question, until);
  return payload ? parse_conf(*payload, item) : std::nullopt;
}

template <class T>
bool put(const std::optional<T>& from, T& to) {
  if (from) to = *from;
  return from.has_value();
}

/// False when it cannot be true, or means nothing to this program.
bool put(ByteView data, ConfItem item, ScanMode& mode) {
  switch (item) {
    case ConfItem::kSampleTime:
      return put(parse_sample_us(data), mode.sample_us);
    case ConfItem::kMaxRange:
      return put(parse_max_range_m(data), mode.max_range_m);
    case ConfItem::kAnswerType:
      return put(parse_answer_type(data), mode.answer);
    default:
      return put(parse_name(data), mode.name);
  }
}

}  // namespace

bool ModeSurvey::ask(DeviceTalk& talk, const DeviceInfo& info, Time until) {
  if (!info.tells_modes()) return ask_legacy(talk, until);
  if (!count_) {
    const auto data = ask_conf(talk, ConfItem::kModeCount, std::nullopt, until);
    if (!data) return false;
    count_ = parse_count(*data).value_or(0);
  }
  if (!typical_) {
    const auto data = ask_conf(talk, ConfItem::kTypicalMode, std::nullopt, until);
    if (!data) return false;
    typical_ = data->size() < 2 ? kNoMode : u16_at(*data, 0);
  }
  while (next_ < *count_) {
    if (!ask_mode(talk, until)) return false;
  }
  if (modes_.empty()) modes_ = {legacy_modes({}).front()};
  return true;
}

bool ModeSurvey::ask_legacy(DeviceTalk& talk, Time until) {
  try {
    const auto payload = talk.ask({request(Command::kGetSampleRate), AnswerType::kSampleRate}, until);
    if (!payload) return false;
    modes_ = legacy_modes(*payload);
  } catch (const NoAnswer&) {
    modes_ = legacy_modes({});
  }
  return true;
}

bool ModeSurvey::ask_mode(DeviceTalk& talk, Time until) {
  for (; next_item_ < kModeItems.size(); ++next_item_) {
    const auto data = ask_conf(talk, kModeItems[next_item_], next_, until);
    if (!data) return false;
    can_use_ = put(*data, kModeItems[next_item_], mode_) && can_use_;
  }
  mode_.id = next_++;
  if (can_use_) modes_.push_back(mode_);
  mode_ = {};
  can_use_ = true;
  next_item_ = 0;
  return true;
}

}  // namespace dynslam::rplidar
