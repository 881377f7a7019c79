// SPDX-License-Identifier: MIT
#include "drivers/rplidar/device_talk.h"

#include <algorithm>

#include "drivers/rplidar/packets.h"

namespace dynslam::rplidar {
namespace {

constexpr std::size_t kChunk = 1024;
/// Of what is not understood no more is kept.
constexpr std::size_t kMostKept = 4 * kChunk;
/// No answer that comes once is longer.
constexpr std::uint32_t kLongestAnswer = 1024;

}  // namespace

void DeviceTalk::open(const std::string& path, int baud) {
  port_.open(path, baud);
  received_.clear();
  asked_at_.reset();
  silent_since_.reset();
}

void DeviceTalk::read(Time until) {
  if (received_.size() > kMostKept) received_.clear();
  std::array<std::uint8_t, kChunk> chunk;
  const std::size_t n = port_.read(chunk, clock_.steady(until));
  received_.insert(received_.end(), chunk.begin(), chunk.begin() + static_cast<std::ptrdiff_t>(n));
}

bool DeviceTalk::drain(Duration silence, Duration longest, Time until) {
  if (!silent_since_) silent_since_ = drain_began_ = clock_.now();
  for (Time now = clock_.now();; now = clock_.now()) {
    if (now >= *silent_since_ + silence || now >= drain_began_ + longest) {
      received_.clear();
      silent_since_.reset();
      return true;
    }
    if (now >= until) return false;
    received_.clear();
    read(std::min(until, *silent_since_ + silence));
    if (!received_.empty()) silent_since_ = clock_.now();
  }
}

/// Calls `take` until it finds the answer in what came. Returns whether it did by `until`.
template <class Take>
bool DeviceTalk::wait_for_answer(const Question& question, Time until, Take&& take) {
  if (!asked_at_) tries_ = 0;
  for (Time now = clock_.now();; now = clock_.now()) {
    if (asked_at_ && take()) {
      asked_at_.reset();
      return true;
    }
    if (!asked_at_ || now >= *asked_at_ + question.patience) {
      if (tries_ == question.tries) {
        asked_at_.reset();
        throw NoAnswer("lidar: " + port_.path() +
                       ": no answer: is it a lidar, and is it getting its 5 V through a good cable?");
      }
      ++tries_;
      received_.clear();
      say(question.request);
      asked_at_ = now;
    }
    if (now >= until) return false;
    read(std::min(until, *asked_at_ + question.patience));
  }
}

void DeviceTalk::drop(std::size_t bytes) {
  received_.erase(received_.begin(), received_.begin() + static_cast<std::ptrdiff_t>(bytes));
}

/// Looks for the answer in what came, past whatever stands before it.
bool DeviceTalk::take_payload(const Question& question) {
  for (std::size_t at = 0; at + AnswerHead::kBytes <= received_.size(); ++at) {
    const ByteView rest = ByteView(received_).subspan(at);
    const auto head = parse_head(rest);
    if (!head || head->type != question.type || head->repeated || head->size > kLongestAnswer) continue;
    if (rest.size() < AnswerHead::kBytes + head->size) return false;
    const ByteView payload = rest.subspan(AnswerHead::kBytes, head->size);
    if (question.accepts && !question.accepts(payload)) continue;
    payload_.assign(payload.begin(), payload.end());
    drop(at + AnswerHead::kBytes + head->size);
    return true;
  }
  return false;
}

bool DeviceTalk::take_stream_head(std::optional<AnswerHead>& found) {
  for (std::size_t at = 0; at + AnswerHead::kBytes <= received_.size(); ++at) {
    const auto head = parse_head(ByteView(received_).subspan(at));
    if (!head || !head->repeated) continue;
    const PacketForm* form = find_form(head->type);
    if (form == nullptr || form->size != head->size) continue;
    found = head;
    drop(at + AnswerHead::kBytes);
    return true;
  }
  return false;
}

std::optional<ByteView> DeviceTalk::ask(const Question& question, Time until) {
  if (!wait_for_answer(question, until, [&] { return take_payload(question); })) return std::nullopt;
  return ByteView(payload_);
}

std::optional<AnswerHead> DeviceTalk::ask_for_stream(const Question& question, Time until) {
  std::optional<AnswerHead> found;
  wait_for_answer(question, until, [&] { return take_stream_head(found); });
  return found;
}

}  // namespace dynslam::rplidar
