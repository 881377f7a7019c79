// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace dynslam::rplidar {

/// A serial line, 8 bits, no parity, at any speed, that nobody else may open meanwhile. All throw DeviceError
/// when the line is gone. One thread.
class SerialPort {
 public:
  using SteadyTime = std::chrono::steady_clock::time_point;

  SerialPort() = default;
  ~SerialPort() { close(); }
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;

  void open(const std::string& path, int baud);
  void close() noexcept;
  bool is_open() const { return fd_ >= 0; }
  const std::string& path() const { return path_; }

  /// read() waits for so many bytes, unless time is up before. REQUIRES: 1 to 255.
  void wait_for(int bytes);
  /// Reads what is there, and waits for it until `deadline` at most. Returns how much it was.
  std::size_t read(std::span<std::uint8_t> into, SteadyTime deadline);
  void write(std::span<const std::uint8_t> bytes);
  /// Sets the line DTR; what has no such line does nothing.
  void set_dtr(bool on) noexcept;

 private:
  void configure();
  [[noreturn]] void fail(const std::string& what) const;

  int fd_ = -1;
  int baud_ = 0;
  int wait_for_ = 1;
  std::string path_;
};

}  // namespace dynslam::rplidar
