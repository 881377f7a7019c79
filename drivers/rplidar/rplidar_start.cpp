// SPDX-License-Identifier: MIT
#include "drivers/rplidar/rplidar_start.h"

#include <algorithm>
#include <cmath>
#include <thread>

#include "drivers/rplidar/find_port.h"
#include "drivers/rplidar/packets.h"

namespace dynslam::rplidar {
namespace {

using std::chrono::milliseconds;

/// In the order in which they are likely.
constexpr std::array<int, 4> kBauds{256000, 115200, 460800, 1000000};
/// A lidar that was just plugged in takes a while until it answers.
constexpr int kTriesWhereKnown = 4;
constexpr Duration kSilence = milliseconds(20), kLongestDrain = milliseconds(300);
constexpr Duration kResetPatience = milliseconds(500);
constexpr int kResetTries = 5;
constexpr Duration kScanPatience = milliseconds(1000);
/// The protocol wants a millisecond.
constexpr Duration kAfterStop = milliseconds(2);

constexpr double kPwmPerTurn = 66.0;  // 660 makes 10 turns a second
constexpr double kMostPwm = 1023.0;
constexpr double kRpmPerTurn = 60.0;

}  // namespace

bool Start::go(Phase next) {
  phase_ = next;
  return true;
}

bool Start::advance(Phase goal, Time until) {
  while (phase_ < goal) {
    if (!step(until)) return false;
  }
  return true;
}

/// False when time is up.
bool Start::step(Time until) {
  switch (phase_) {
    case Phase::kClosed:
      return open();
    case Phase::kQuieting:
      return talk_.drain(kSilence, kLongestDrain, until) && go(Phase::kAsking);
    case Phase::kAsking:
      return ask_info(until);
    case Phase::kHealth:
      return ask_health(until);
    case Phase::kResetting:
      return reset(until);
    case Phase::kModes:
      return ask_modes(until);
    case Phase::kMotor:
      return start_motor(until);
    case Phase::kScan:
      return start_scan(until);
    case Phase::kMeasuring:
      break;
  }
  return true;
}

std::vector<Start::Way> Start::ways() const {
  std::vector<std::string> ports{config_.port};
  if (config_.port == "auto") ports = find_ports(config_.port_folder);
  std::vector<Way> all;
  for (const std::string& port : ports) {
    if (known_ && known_->port == port) all.insert(all.begin(), kTriesWhereKnown, *known_);
    if (config_.baud > 0) all.push_back({port, config_.baud});
    for (const int baud : kBauds) {
      if (baud != config_.baud) all.push_back({port, baud});
    }
  }
  return all;
}

bool Start::open() {
  if (ways_.empty()) {
    ways_ = ways();
    tried_.clear();
    if (ways_.empty())
      throw DeviceError("lidar: no USB adapter in " + config_.port_folder +
                        ": is it plugged in? If it is no CP210x, set rplidar.port");
  }
  const Way way = ways_.front();
  portrait_ = {};
  portrait_.port = way.port;
  portrait_.baud = way.baud;
  was_reset_ = false;
  survey_ = {};
  motor_ = Motor::kUnknown;
  try {
    talk_.open(way.port, way.baud);
  } catch (const DeviceError&) {
    std::erase_if(ways_, [&](const Way& w) { return w.port == way.port; });
    if (ways_.empty()) throw;
    return go(Phase::kClosed);
  }
  talk_.port().set_dtr(false);  // set, it stops the motor
  talk_.say(request(Command::kStop));
  return go(Phase::kQuieting);
}

bool Start::ask_info(Time until) {
  const DeviceTalk::Question question{request(Command::kGetInfo), AnswerType::kInfo, milliseconds(150), 2,
                                      [](ByteView payload) { return parse_info(payload).has_value(); }};
  try {
    const auto payload = talk_.ask(question, until);
    if (!payload) return false;
    portrait_.info = parse_info(*payload);
  } catch (const NoAnswer&) {
    const std::string baud = std::to_string(ways_.front().baud);
    if (tried_.find(baud) == std::string::npos) tried_ += (tried_.empty() ? "" : ", ") + baud;
    talk_.close();
    ways_.erase(ways_.begin());
    if (!ways_.empty()) return go(Phase::kClosed);
    throw DeviceError("lidar: " + portrait_.port + ": no answer at " + tried_ +
                      " baud: is it a lidar, and does it get its 5 V through a good cable?");
  }
  known_ = ways_.front();
  motor_ = motor_of(*portrait_.info);
  return go(Phase::kHealth);
}

bool Start::ask_health(Time until) {
  const auto payload = talk_.ask({request(Command::kGetHealth), AnswerType::kHealth, milliseconds(150), 3,
                                  [](ByteView answer) { return parse_health(answer).has_value(); }},
                                 until);
  if (!payload) return false;
  portrait_.health = parse_health(*payload);
  if (portrait_.health->status != Health::Status::kProtectionStop) return go(Phase::kModes);
  if (was_reset_)
    throw DeviceError("lidar: " + in_words(*portrait_.health) +
                      ": is its head free to turn? Take its power away for a while");
  was_reset_ = true;
  talk_.say(request(Command::kReset));
  return go(Phase::kResetting);
}

/// It prints a greeting, and then answers again.
bool Start::reset(Time until) {
  const auto payload = talk_.ask({request(Command::kGetInfo), AnswerType::kInfo, kResetPatience, kResetTries,
                                  [](ByteView answer) { return parse_info(answer).has_value(); }},
                                 until);
  return payload && go(Phase::kHealth);
}

bool Start::ask_modes(Time until) {
  if (!survey_.ask(talk_, *portrait_.info, until)) return false;
  portrait_.modes = survey_.modes();
  return choose();
}

bool Start::choose() {
  portrait_.mode = choose_mode(portrait_.modes, config_.mode, survey_.typical());
  if (portrait_.mode) return go(Phase::kMotor);
  std::string names;
  for (const ScanMode& mode : portrait_.modes) names += (names.empty() ? "" : ", ") + mode.name;
  throw DeviceError("lidar: has no mode '" + config_.mode + "' but " + names + ": set rplidar.mode");
}

/// As far as the model says it.
Start::Motor Start::motor_of(const DeviceInfo& info) {
  if (info.family() == 1) return Motor::kDtr;
  return info.family() >= 6 ? Motor::kRpm : Motor::kUnknown;
}

bool Start::ask_motor(Time until) {
  if (motor_ != Motor::kUnknown) return true;
  DeviceTalk::Question question{accessory_request(), AnswerType::kAccessory};
  question.accepts = [](ByteView answer) { return answer.size() == 4; };
  try {
    const auto payload = talk_.ask(question, until);
    if (!payload) return false;
    motor_ = ((*payload)[0] & 1) != 0 ? Motor::kPwm : Motor::kDtr;
  } catch (const NoAnswer&) {
    motor_ = Motor::kDtr;
  }
  return true;
}

bool Start::start_motor(Time until) {
  if (!ask_motor(until)) return false;
  turn_motor(true);
  return go(Phase::kScan);
}

void Start::turn_motor(bool on) {
  const double turns_per_s = on ? config_.turns_per_s : 0.0;
  const auto rounded = [](double v) { return static_cast<std::uint16_t>(std::lround(v)); };
  switch (motor_) {
    case Motor::kUnknown:
      break;
    case Motor::kDtr:
      talk_.port().set_dtr(!on);
      break;
    case Motor::kPwm:
      talk_.say(motor_request(Command::kMotorPwm, rounded(std::min(kMostPwm, kPwmPerTurn * turns_per_s))));
      break;
    case Motor::kRpm:
      talk_.say(motor_request(Command::kMotorRpm, rounded(kRpmPerTurn * turns_per_s)));
      break;
  }
}

/// It answers at once, and measures as soon as it turns evenly.
bool Start::start_scan(Time until) {
  const ScanMode& mode = *portrait_.mode;
  const bool plain = !mode.id || mode.answer == AnswerType::kStandard;
  DeviceTalk::Question question;
  question.request = plain ? request(Command::kScan) : express_request(*mode.id);
  question.patience = kScanPatience;
  question.tries = 2;
  try {
    const auto head = talk_.ask_for_stream(question, until);
    if (!head) return false;
    answer_ = head->type;
    return go(Phase::kMeasuring);
  } catch (const NoAnswer&) {
    if (plain) throw;
    // Every lidar knows the plain scan.
    const auto is_plain = [](const ScanMode& m) { return m.answer == AnswerType::kStandard; };
    const auto it = std::find_if(portrait_.modes.begin(), portrait_.modes.end(), is_plain);
    portrait_.mode = it == portrait_.modes.end() ? legacy_modes({}).front() : *it;
    return true;
  }
}

void Start::stop() noexcept {
  if (talk_.port().is_open()) {
    try {
      talk_.say(request(Command::kStop));
      if (motor_ != Motor::kUnknown) {  // even if it was started by somebody else, or by opening the port
        std::this_thread::sleep_for(kAfterStop);
        turn_motor(false);
      }
    } catch (const DeviceError&) {  // it is gone, and nothing more can be done
    }
    talk_.close();
  }
  ways_.clear();
  phase_ = Phase::kClosed;
}

}  // namespace dynslam::rplidar
