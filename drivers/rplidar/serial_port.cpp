// SPDX-License-Identifier: MIT
#include "drivers/rplidar/serial_port.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <asm/termbits.h>  // termios2, for any baud rate; <termios.h> contradicts it
#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "device/device_error.h"

namespace dynslam::rplidar {
namespace {

std::string reason_of(int error, const std::string& path) {
  switch (error) {
    case ENOENT:
    case ENODEV:
    case ENXIO:
      return "no " + path + ": is it plugged in?";
    case EACCES:
    case EPERM:
      return path + " may not be opened: is the user in group dialout?";
    case EBUSY:
      return path + " is in use: does another program read the lidar?";
    default:
      return path + " cannot be opened: " + std::strerror(error);
  }
}

timespec until(SerialPort::SteadyTime deadline) {
  using std::chrono::nanoseconds;
  const auto left = std::max(nanoseconds::zero(), nanoseconds(deadline - std::chrono::steady_clock::now()));
  return {static_cast<time_t>(left.count() / 1'000'000'000), static_cast<long>(left.count() % 1'000'000'000)};
}

}  // namespace

void SerialPort::fail(const std::string& what) const {
  throw DeviceError("lidar: " + path_ + ": " + what + ": was it unplugged?");
}

void SerialPort::open(const std::string& path, int baud) {
  close();
  path_ = path;
  baud_ = baud;
  wait_for_ = 1;
  fd_ = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (fd_ < 0) throw DeviceError("lidar: " + reason_of(errno, path));
  if (ioctl(fd_, TIOCEXCL) != 0) {
    const std::string reason = std::strerror(errno);
    close();
    throw DeviceError("lidar: " + path + " is no serial port: " + reason);
  }
  configure();
  ioctl(fd_, TCFLSH, TCIOFLUSH);
}

void SerialPort::close() noexcept {
  if (fd_ < 0) return;
  ioctl(fd_, TIOCNXCL);
  ::close(std::exchange(fd_, -1));
}

void SerialPort::configure() {
  termios2 line{};
  if (ioctl(fd_, TCGETS2, &line) != 0) fail(std::strerror(errno));
  line.c_iflag = line.c_oflag = line.c_lflag = 0;
  line.c_cflag = BOTHER | CS8 | CREAD | CLOCAL;
  line.c_ispeed = line.c_ospeed = static_cast<speed_t>(baud_);
  line.c_cc[VMIN] = static_cast<cc_t>(wait_for_);
  line.c_cc[VTIME] = 0;
  if (ioctl(fd_, TCSETS2, &line) != 0) fail(std::strerror(errno));
}

void SerialPort::wait_for(int bytes) {
  if (std::exchange(wait_for_, bytes) != bytes) configure();
}

std::size_t SerialPort::read(std::span<std::uint8_t> into, SteadyTime deadline) {
  pollfd ready{fd_, POLLIN, 0};
  const timespec left = until(deadline);
  if (ppoll(&ready, 1, &left, nullptr) < 0 && errno != EINTR) fail(std::strerror(errno));
  // Even if time is up: fewer bytes than it waits for may be there.
  const ssize_t n = ::read(fd_, into.data(), into.size());
  if (n > 0) return static_cast<std::size_t>(n);
  if (n < 0 && (errno == EAGAIN || errno == EINTR)) {
    if ((ready.revents & (POLLHUP | POLLERR | POLLNVAL)) != 0) fail("hung up");
    return 0;
  }
  fail(n == 0 ? "hung up" : std::strerror(errno));
}

void SerialPort::write(std::span<const std::uint8_t> bytes) {
  const ssize_t n = ::write(fd_, bytes.data(), bytes.size());
  if (n != static_cast<ssize_t>(bytes.size())) fail(n < 0 ? std::strerror(errno) : "takes no bytes");
}

void SerialPort::set_dtr(bool on) noexcept {
  int line = TIOCM_DTR;
  ioctl(fd_, on ? TIOCMBIS : TIOCMBIC, &line);
}

}  // namespace dynslam::rplidar
