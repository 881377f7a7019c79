// SPDX-License-Identifier: MIT
#include "drivers/rplidar/messages.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>

#include "drivers/rplidar/packets.h"

namespace dynslam::rplidar {
namespace {

constexpr std::uint8_t kStart = 0xA5, kAnswerStart = 0x5A;
constexpr std::uint8_t kHasPayload = 0x80;
constexpr double kQ8 = 256.0;

/// Of lidars that do not say it.
constexpr double kLegacySample_us = 476.0, kLegacyRange_m = 16.0;
constexpr double kLeastSample_us = 5.0, kMostSample_us = 5000.0;
constexpr double kMostRange_m = 500.0;
constexpr std::uint16_t kMostModes = 32;

std::array<std::uint8_t, 2> bytes_of(std::uint16_t v) {
  return {static_cast<std::uint8_t>(v), static_cast<std::uint8_t>(v >> 8)};
}

bool is_same(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return lower(x) == lower(y); });
}

bool is_sample_time(double us) { return us >= kLeastSample_us && us <= kMostSample_us; }

}  // namespace

std::vector<std::uint8_t> request(Command command, ByteView payload) {
  std::vector<std::uint8_t> bytes{kStart, static_cast<std::uint8_t>(command)};
  if ((static_cast<std::uint8_t>(command) & kHasPayload) == 0) return bytes;
  bytes.push_back(static_cast<std::uint8_t>(payload.size()));
  bytes.insert(bytes.end(), payload.begin(), payload.end());
  bytes.push_back(xor_of(bytes));
  return bytes;
}

std::vector<std::uint8_t> conf_request(ConfItem item, std::optional<std::uint16_t> mode) {
  std::vector<std::uint8_t> payload{static_cast<std::uint8_t>(item), 0, 0, 0};
  if (mode) {
    const auto id = bytes_of(*mode);
    payload.insert(payload.end(), id.begin(), id.end());
  }
  return request(Command::kGetConf, payload);
}

std::vector<std::uint8_t> express_request(std::uint16_t mode) {
  return request(Command::kExpressScan,
                 std::array<std::uint8_t, 5>{static_cast<std::uint8_t>(mode), 0, 0, 0, 0});
}

std::vector<std::uint8_t> motor_request(Command command, std::uint16_t value) {
  return request(command, bytes_of(value));
}

std::vector<std::uint8_t> accessory_request() {
  return request(Command::kGetAccessory, std::array<std::uint8_t, 4>{});
}

std::optional<AnswerHead> parse_head(ByteView bytes) {
  if (bytes.size() < AnswerHead::kBytes || bytes[0] != kStart || bytes[1] != kAnswerStart)
    return std::nullopt;
  const std::uint32_t word = u32_at(bytes, 2);
  return AnswerHead{word & 0x3FFFFFFF, (word >> 30) != 0, static_cast<AnswerType>(bytes[6])};
}

std::string DeviceInfo::model_name() const {
  struct Series {
    int first;
    char letter;
  };
  constexpr std::array<Series, 5> kSeries{{{12, 'M'}, {9, 'T'}, {6, 'S'}, {4, 'C'}, {1, 'A'}}};
  for (const auto& [first, letter] : kSeries) {
    if (family() >= first)
      return letter + std::to_string(family() - first + 1) + "M" + std::to_string(model & 0xF);
  }
  return "model " + std::to_string(model);
}

std::string DeviceInfo::firmware() const {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%d.%02d", firmware_major, firmware_minor);
  return text.data();
}

bool DeviceInfo::tells_modes() const {
  return family() >= 4 || firmware_major > 1 || (firmware_major == 1 && firmware_minor >= 24);
}

std::optional<DeviceInfo> parse_info(ByteView payload) {
  if (payload.size() != 20) return std::nullopt;
  DeviceInfo info{payload[0], payload[2], payload[1], payload[3], {}};
  for (const std::uint8_t b : payload.subspan(4)) {
    for (const int digit : {b >> 4, b & 0xF}) info.serial += "0123456789ABCDEF"[digit];
  }
  return info;
}

std::optional<Health> parse_health(ByteView payload) {
  if (payload.size() != 3 || payload[0] > 2) return std::nullopt;
  return Health{static_cast<Health::Status>(payload[0]), u16_at(payload, 1)};
}

std::string in_words(const Health& health) {
  std::array<char, 16> code{};
  std::snprintf(code.data(), code.size(), " (code %04X)", health.code);
  switch (health.status) {
    case Health::Status::kFine:
      return "fine";
    case Health::Status::kWarning:
      return std::string("warns that it may soon fail") + code.data();
    case Health::Status::kProtectionStop:
      break;
  }
  return std::string("stopped to protect itself") + code.data();
}

std::optional<ByteView> parse_conf(ByteView payload, ConfItem item) {
  if (payload.size() < 4 || u32_at(payload, 0) != static_cast<std::uint32_t>(item)) return std::nullopt;
  return payload.subspan(4);
}

std::optional<std::uint16_t> parse_count(ByteView data) {
  if (data.size() < 2 || u16_at(data, 0) > kMostModes) return std::nullopt;
  return u16_at(data, 0);
}

std::optional<double> parse_sample_us(ByteView data) {
  if (data.size() < 4) return std::nullopt;
  const double us = u32_at(data, 0) / kQ8;
  return is_sample_time(us) ? std::optional(us) : std::nullopt;
}

std::optional<double> parse_max_range_m(ByteView data) {
  if (data.size() < 4) return std::nullopt;
  const double range_m = u32_at(data, 0) / kQ8;
  return range_m > 0.0 && range_m <= kMostRange_m ? std::optional(range_m) : std::nullopt;
}

std::optional<AnswerType> parse_answer_type(ByteView data) {
  if (data.empty() || find_form(static_cast<AnswerType>(data[0])) == nullptr) return std::nullopt;
  return static_cast<AnswerType>(data[0]);
}

std::optional<std::string> parse_name(ByteView data) {
  const std::string name(data.begin(), std::find(data.begin(), data.end(), 0));
  const auto is_print = [](char c) { return c >= ' ' && c <= '~'; };
  if (name.empty() || !std::all_of(name.begin(), name.end(), is_print)) return std::nullopt;
  return name;
}

std::vector<ScanMode> legacy_modes(ByteView sample_rate) {
  double standard_us = kLegacySample_us, express_us = 0.5 * kLegacySample_us;
  if (sample_rate.size() == 4 && is_sample_time(u16_at(sample_rate, 0)) &&
      is_sample_time(u16_at(sample_rate, 2))) {
    standard_us = u16_at(sample_rate, 0);
    express_us = u16_at(sample_rate, 2);
  }
  return {{std::nullopt, "Standard", standard_us, kLegacyRange_m, AnswerType::kStandard},
          {0, "Express", express_us, kLegacyRange_m, AnswerType::kExpress}};
}

std::optional<ScanMode> choose_mode(const std::vector<ScanMode>& modes, std::string_view name,
                                    std::optional<std::uint16_t> typical) {
  const bool any = is_same(name, "auto");
  const ScanMode* fastest = nullptr;
  for (const ScanMode& mode : modes) {
    if (any ? typical && mode.id == typical : is_same(mode.name, name)) return mode;
    if (fastest == nullptr || mode.sample_us < fastest->sample_us) fastest = &mode;
  }
  return any && fastest != nullptr ? std::optional(*fastest) : std::nullopt;
}

}  // namespace dynslam::rplidar
