// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/rplidar/bytes.h"

/// What is said to an RPLIDAR, and what it answers, measurements apart. Slamtec, "RPLIDAR interface
/// protocol".
namespace dynslam::rplidar {

enum class Command : std::uint8_t {
  kScan = 0x20,
  kStop = 0x25,
  kReset = 0x40,
  kGetInfo = 0x50,
  kGetHealth = 0x52,
  kGetSampleRate = 0x59,
  kExpressScan = 0x82,
  kGetConf = 0x84,
  kMotorRpm = 0xA8,
  kMotorPwm = 0xF0,
  kGetAccessory = 0xFF,
};

enum class AnswerType : std::uint8_t {
  kInfo = 0x04,
  kHealth = 0x06,
  kSampleRate = 0x15,
  kConf = 0x20,
  kStandard = 0x81,
  kExpress = 0x82,
  kHq = 0x83,
  kUltra = 0x84,
  kDense = 0x85,
  kUltraDense = 0x86,
  kAccessory = 0xFF,
};

/// What GET_LIDAR_CONF is asked for.
enum class ConfItem : std::uint32_t {
  kModeCount = 0x70,
  kSampleTime = 0x71,
  kMaxRange = 0x74,
  kAnswerType = 0x75,
  kTypicalMode = 0x7C,
  kModeName = 0x7F,
};

std::vector<std::uint8_t> request(Command command, ByteView payload = {});
std::vector<std::uint8_t> conf_request(ConfItem item, std::optional<std::uint16_t> mode = std::nullopt);
std::vector<std::uint8_t> express_request(std::uint16_t mode);
std::vector<std::uint8_t> motor_request(Command command, std::uint16_t value);
std::vector<std::uint8_t> accessory_request();

/// What precedes every answer.
struct AnswerHead {
  std::uint32_t size = 0;  ///< of the payload, bytes
  bool repeated = false;   ///< payloads follow each other until STOP
  AnswerType type{};

  static constexpr std::size_t kBytes = 7;
};
/// Nothing when these bytes are no head.
std::optional<AnswerHead> parse_head(ByteView bytes);

struct DeviceInfo {
  std::uint8_t model = 0;
  std::uint8_t firmware_major = 0, firmware_minor = 0;
  std::uint8_t hardware = 0;
  std::string serial;  ///< 32 hexadecimal digits

  /// 1 to 3: A1 to A3; 4, 5: C; 6 to 8: S; 9 to 11: T; then M.
  int family() const { return model >> 4; }
  std::string model_name() const;
  std::string firmware() const;
  /// Whether it knows GET_LIDAR_CONF.
  bool tells_modes() const;
};
std::optional<DeviceInfo> parse_info(ByteView payload);

struct Health {
  enum class Status : std::uint8_t { kFine = 0, kWarning = 1, kProtectionStop = 2 };
  Status status = Status::kFine;
  std::uint16_t code = 0;
};
std::optional<Health> parse_health(ByteView payload);
std::string in_words(const Health& health);

/// A way to measure. `id` is none for the plain SCAN that every lidar knows.
struct ScanMode {
  std::optional<std::uint16_t> id;
  std::string name;
  double sample_us = 0.0;  ///< from one beam to the next
  double max_range_m = 0.0;
  AnswerType answer = AnswerType::kStandard;
};

/// The data of an answer of GET_LIDAR_CONF; nothing when it answers another question.
std::optional<ByteView> parse_conf(ByteView payload, ConfItem item);
/// Nothing when the data cannot be true.
std::optional<std::uint16_t> parse_count(ByteView data);
std::optional<double> parse_sample_us(ByteView data);
std::optional<double> parse_max_range_m(ByteView data);
std::optional<AnswerType> parse_answer_type(ByteView data);
std::optional<std::string> parse_name(ByteView data);

/// The modes of a lidar that does not tell them; the payload is the answer of GET_SAMPLERATE, if there is
/// one.
std::vector<ScanMode> legacy_modes(ByteView sample_rate);

/// The mode of this name, whatever its case; for "auto" the typical one, or else the fastest. Nothing when it
/// has no such mode. REQUIRES: modes are none but such as can be decoded.
std::optional<ScanMode> choose_mode(const std::vector<ScanMode>& modes, std::string_view name,
                                    std::optional<std::uint16_t> typical);

}  // namespace dynslam::rplidar
