// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "base/time.h"
#include "device/device_error.h"
#include "drivers/rplidar/messages.h"
#include "drivers/rplidar/serial_port.h"
#include "pipe/clock.h"

namespace dynslam::rplidar {

/// The lidar did not answer, however often it was asked.
struct NoAnswer : DeviceError {
  using DeviceError::DeviceError;
};

/// Asks and waits for answers, in pieces: who is told nothing yet asks the same again, and goes on waiting.
/// All but `say` wait until the robot's clock says `until` at most, and throw DeviceError. One thread.
class DeviceTalk {
 public:
  explicit DeviceTalk(const Clock& clock) : clock_(clock) {}

  void open(const std::string& path, int baud);
  void close() noexcept { port_.close(); }
  SerialPort& port() { return port_; }

  void say(ByteView request) { port_.write(request); }
  /// Throws away what comes until nothing has come for a while, or for too long a time. True when done.
  bool drain(Duration silence, Duration longest, Time until);

  struct Question {
    std::vector<std::uint8_t> request;
    AnswerType type{};
    Duration patience = std::chrono::milliseconds(150);
    int tries = 3;
    std::function<bool(ByteView payload)> accepts{};  ///< whether it answers this; none: any of its type does
  };
  /// The answer's payload, valid until the next call. Throws NoAnswer.
  std::optional<ByteView> ask(const Question& question, Time until);
  /// For measurements, which go on and on: the head of the answers, which have yet to come.
  std::optional<AnswerHead> ask_for_stream(const Question& question, Time until);
  /// What came behind that head.
  ByteView leftover() const { return received_; }

 private:
  template <class Take>
  bool wait_for_answer(const Question& question, Time until, Take&& take);
  bool take_payload(const Question& question);
  bool take_stream_head(std::optional<AnswerHead>& found);
  void drop(std::size_t bytes);
  void read(Time until);

  const Clock& clock_;
  SerialPort port_;
  std::vector<std::uint8_t> received_, payload_;
  std::optional<Time> asked_at_, silent_since_;
  Time drain_began_;
  int tries_ = 0;
};

}  // namespace dynslam::rplidar
