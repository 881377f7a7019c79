// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <string_view>

#include "base/counters.h"
#include "device/device_error.h"

namespace dynslam {

/// One chip on an I2C bus, by the kernel's /dev/i2c-N, for one program at a time. The bus is opened at the
/// first transfer and, once it went away, again at the next. A transfer that fails as transfers do now and
/// then (no acknowledgement, a stretched clock read wrongly) is tried again; a bus that hangs is not, as each
/// try takes its time-out of 50 ms. (Software buses have a time-out of their own, and may call hanging a
/// missing acknowledgement.) Any thread: a mutex keeps a question and its answer together.
///
/// Transfers return 0 or an errno; failure() puts it into words.
class I2cDevice {
 public:
  static constexpr int kTries = 3;

  /// `name` begins the error texts. REQUIRES: a 7-bit address.
  I2cDevice(std::string name, std::string bus, int address);
  ~I2cDevice();
  I2cDevice(const I2cDevice&) = delete;
  I2cDevice& operator=(const I2cDevice&) = delete;

  /// Reads `into.size()` registers from `first` on in one transfer. REQUIRES: at least one.
  [[nodiscard]] int read_registers(std::uint8_t first, std::span<std::uint8_t> into, int tries = kTries);
  /// Writes registers from `first` on; or a command, which is `first`, with its arguments. REQUIRES: at most
  /// 32 values.
  [[nodiscard]] int write(std::uint8_t first, std::span<const std::uint8_t> values = {}, int tries = kTries);
  /// Writes a command and then reads its answer in a transfer of its own (not by a repeated start).
  [[nodiscard]] int ask(std::uint8_t command, std::span<std::uint8_t> answer, int tries = kTries);

  /// One line: what went wrong, and where to look.
  DeviceError failure(int error) const;
  const std::string& name() const { return name_; }

  /// Whether the processor moves this bus's wires itself, known after the first transfer.
  bool is_software_bus() const { return software_bus_; }

  /// The weather: "nak", "timeouts" and "failed" for each try that went wrong, "retries", and what the owner
  /// counts besides.
  void count(std::string_view what, std::uint64_t n = 1);
  Counters counters() const;

 private:
  template <class Transfer>
  int attempt(int tries, Transfer&& transfer);
  int open_bus();
  void close_bus();
  void note(int error);

  const std::string name_, bus_;
  const int address_;
  std::mutex mutex_;
  int bus_file_ = -1;  ///< guarded by mutex_
  std::atomic<bool> software_bus_{false};
  mutable std::mutex counters_mutex_;
  Counters counters_;
};

}  // namespace dynslam
