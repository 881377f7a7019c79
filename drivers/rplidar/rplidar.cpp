// SPDX-License-Identifier: MIT
#include "drivers/rplidar/rplidar.h"

#include <algorithm>
#include <array>

namespace dynslam {

using namespace rplidar;

namespace {

/// Before the first packet it spins up.
constexpr Duration kSpinUp = std::chrono::seconds(6);
constexpr Duration kPacketPatience = std::chrono::seconds(1);
constexpr Duration kTurnPatience = std::chrono::seconds(3);
/// A read waits for about so much, instead of for each byte.
constexpr Duration kReadEvery = std::chrono::milliseconds(5);
constexpr int kMostWaitedFor = 250;

/// So many whole packets as come in that time, or a part of a long one.
int bytes_to_wait_for(const PacketForm& form, Duration sample) {
  const auto packets = kReadEvery / (sample * static_cast<int>(form.samples));
  const auto bytes = static_cast<std::int64_t>(form.size) * std::max<std::int64_t>(1, packets);
  return static_cast<int>(std::min<std::int64_t>(kMostWaitedFor, bytes));
}

void add(StreamCounts& sum, const StreamCounts& more) {
  sum.packets += more.packets;
  sum.bad_checksums += more.bad_checksums;
  sum.skipped_bytes += more.skipped_bytes;
  sum.odd_steps += more.odd_steps;
}

}  // namespace

Rplidar::Rplidar(const RplidarConfig& config, const LidarMount& mount, const Clock& clock)
    : config_(config), mount_(mount), clock_(clock), start_(config, clock) {}

Rplidar::~Rplidar() { stop(); }

void Rplidar::stop() noexcept {
  start_.stop();
  if (stream_) add(past_.line, stream_->counts());
  if (builder_) past_.holed_turns += builder_->holed();
  stream_.reset();
  builder_.reset();
}

bool Rplidar::identify(Time until) {
  try {
    return start_.identify(until);
  } catch (const DeviceError&) {
    stop();
    throw;
  }
}

std::optional<Scan> Rplidar::next(Time until) {
  try {
    if (!stream_) {
      if (!start_.measure(until)) return std::nullopt;
      begin_measuring();
    }
    return read_turn(until);
  } catch (const DeviceError&) {
    stop();
    throw;
  }
}

void Rplidar::begin_measuring() {
  const Portrait& device = start_.portrait();
  const PacketForm& form = *find_form(start_.answer());
  const Duration sample = from_seconds(1e-6 * device.mode->sample_us);
  stream_.emplace(StreamForm{&form, sample, device.baud, from_seconds(config_.delay_s)});
  builder_.emplace(mount_);
  packet_at_ = turn_at_ = clock_.now();
  any_packet_ = false;
  start_.talk().port().wait_for(bytes_to_wait_for(form, sample));
  take(start_.talk().leftover());
}

std::optional<Scan> Rplidar::read_turn(Time until) {
  std::array<std::uint8_t, 4096> chunk;
  for (;;) {
    if (!ready_.empty()) {
      std::optional<Scan> scan = std::move(ready_.front());
      ready_.erase(ready_.begin());
      return scan;
    }
    const std::size_t n = start_.talk().port().read(chunk, clock_.steady(until));
    take(ByteView(chunk).first(n));
    const Time now = clock_.now();
    check_patience(now);
    if (ready_.empty() && now >= until) return std::nullopt;
  }
}

void Rplidar::take(ByteView bytes) {
  const Time now = clock_.now();
  const std::uint64_t packets = stream_->counts().packets;
  samples_.clear();
  stream_->feed(bytes, now, samples_);
  if (stream_->counts().packets > packets) {
    if (!any_packet_) turn_at_ = now;
    any_packet_ = true;
    packet_at_ = now;
  }
  for (const Sample& sample : samples_) {
    std::optional<Scan> turn = builder_->add(sample);
    if (!turn) continue;
    turn_at_ = now;
    ++past_.turns;
    past_.turns_per_s = 1.0 / std::max(1e-3, to_seconds(sample.time - turn->stamp));
    ready_.push_back(std::move(*turn));
  }
}

void Rplidar::check_patience(Time now) const {
  const std::string& port = start_.portrait().port;
  if (now > packet_at_ + (any_packet_ ? kPacketPatience : kSpinUp))
    throw DeviceError("lidar: " + port + ": no measurements: does its head turn?");
  if (any_packet_ && now > turn_at_ + kTurnPatience)
    throw DeviceError("lidar: " + port + ": no whole turn: does its head turn evenly, is its cable sound?");
}

RplidarReport Rplidar::report() const {
  RplidarReport report = past_;
  report.device = start_.portrait();
  if (stream_) add(report.line, stream_->counts());
  if (builder_) report.holed_turns += builder_->holed();
  return report;
}

std::string Rplidar::about() const {
  const Portrait& device = start_.portrait();
  if (!device.info) return {};
  std::string text = device.info->model_name() + ", firmware " + device.info->firmware() + ", " +
                     std::to_string(device.baud) + " baud";
  if (device.mode) text += ", mode " + device.mode->name;
  return text;
}

Counters Rplidar::counters() const {
  const RplidarReport now = report();
  Counters all;
  const auto add = [&all](const char* name, std::uint64_t n) {
    if (n > 0) all.add(name, n);
  };
  add("bad-checksums", now.line.bad_checksums);
  add("skipped-bytes", now.line.skipped_bytes);
  add("odd-steps", now.line.odd_steps);
  add("holed-turns", now.holed_turns);
  return all;
}

}  // namespace dynslam
