// SPDX-License-Identifier: MIT
#include "tests/drivers/rplidar_emulator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include <asm/termbits.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "base/angles.h"
#include "drivers/real_time.h"

namespace dynslam::test {
namespace {

using std::chrono::milliseconds;

constexpr Duration kBoot = milliseconds(300);
constexpr Duration kAdapter = milliseconds(1);
/// What a busy computer did not come to send for so long is lost.
constexpr Duration kLongestBehind = milliseconds(200);
const char* const kLinkName = "usb-Silicon_Labs_CP2102_USB_to_UART_Bridge_Controller_0001-if00-port0";
const std::string kGreeting = "RP LIDAR System.\r\nFirmware Ver 1.29 - rc7, HW Ver 7\r\nModel: 49\r\n";

}  // namespace

RplidarEmulator::RplidarEmulator(EmulatedLidar kind, const Clock& clock, std::string folder, Ranger ranger)
    : kind_(std::move(kind)), clock_(clock), folder_(std::move(folder)), ranger_(std::move(ranger)) {
  std::filesystem::create_directories(folder_);
  open_port();
  awake_at_ = clock_.now();
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

RplidarEmulator::~RplidarEmulator() {
  thread_.request_stop();
  thread_.join();
  close_port();
}

std::string RplidarEmulator::port() const { return folder_ + "/" + kLinkName; }

void RplidarEmulator::open_port() {
  fd_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  std::array<char, 64> name{};
  if (fd_ < 0 || grantpt(fd_) != 0 || unlockpt(fd_) != 0 || ptsname_r(fd_, name.data(), name.size()) != 0)
    throw std::runtime_error("no pseudo-terminal");
  // A fresh one echoes.
  termios2 raw{};
  ioctl(fd_, TCGETS2, &raw);
  raw.c_iflag = raw.c_oflag = raw.c_lflag = 0;
  ioctl(fd_, TCSETS2, &raw);
  std::filesystem::remove(port());
  std::filesystem::create_symlink(name.data(), port());
}

void RplidarEmulator::close_port() {
  if (fd_ < 0) return;
  std::filesystem::remove(port());
  ::close(std::exchange(fd_, -1));
}

void RplidarEmulator::unplug() {
  const std::lock_guard lock(mutex_);
  close_port();
  stream_.reset();
  turns_per_s_ = 0.0;
}

void RplidarEmulator::plug_in() {
  const std::lock_guard lock(mutex_);
  open_port();
  heard_.clear();
  awake_at_ = clock_.now() + kBoot;
  greet_at_ = awake_at_;
  health_ = 0;
}

void RplidarEmulator::drop_byte() {
  const std::lock_guard lock(mutex_);
  ++drops_;
}

void RplidarEmulator::flip_bit() {
  const std::lock_guard lock(mutex_);
  ++flips_;
}

int RplidarEmulator::faults_done() const {
  const std::lock_guard lock(mutex_);
  return faults_done_;
}

void RplidarEmulator::be_silent(bool silent) {
  const std::lock_guard lock(mutex_);
  silent_ = silent;
}

void RplidarEmulator::stop_to_protect(bool lasting) {
  const std::lock_guard lock(mutex_);
  health_ = 2;
  lasting_ = lasting;
  stream_.reset();
  turns_per_s_ = 0.0;
}

void RplidarEmulator::set_spin_up(Duration length) {
  const std::lock_guard lock(mutex_);
  spin_up_ = length;
}

void RplidarEmulator::begin_untidily() {
  const std::lock_guard lock(mutex_);
  untidy_ = true;
}

bool RplidarEmulator::turns() const {
  const std::lock_guard lock(mutex_);
  return turns_per_s_ > 0.0;
}

bool RplidarEmulator::measures() const {
  const std::lock_guard lock(mutex_);
  return stream_.has_value();
}

int RplidarEmulator::resets() const {
  const std::lock_guard lock(mutex_);
  return resets_;
}

void RplidarEmulator::run(const std::stop_token& stop) {
  be_no_part_of_the_program();
  while (!stop.stop_requested()) {
    int fd = -1;
    Time wake = clock_.now() + milliseconds(2);
    {
      const std::lock_guard lock(mutex_);
      if (fd_ >= 0) {
        listen();
        send_due_packets();
        if (stream_) wake = std::min(wake, due());
        fd = dup(fd_);
      }
    }
    const auto left =
        std::max(Duration::zero(), Duration(clock_.steady(wake) - std::chrono::steady_clock::now()));
    const timespec wait{0, static_cast<long>(std::min<std::int64_t>(left.count(), 999'999'999))};
    pollfd ready{fd, POLLIN, 0};
    ppoll(&ready, 1, &wait, nullptr);
    if ((ready.revents & POLLHUP) != 0) std::this_thread::sleep_for(milliseconds(1));  // nobody listens
    if (fd >= 0) ::close(fd);
  }
}

/// Bytes at another speed are noise.
bool RplidarEmulator::hears() const {
  termios2 line{};
  ioctl(fd_, TCGETS2, &line);
  return line.c_ospeed == static_cast<speed_t>(kind_.baud);
}

void RplidarEmulator::listen() {
  const Time now = clock_.now();
  if (greet_at_ && now >= *greet_at_) {
    send(PacketBytes(kGreeting.begin(), kGreeting.end()));
    greet_at_.reset();
  }
  std::array<std::uint8_t, 256> chunk;
  const ssize_t n = ::read(fd_, chunk.data(), chunk.size());
  if (n <= 0 || now < awake_at_ || !hears()) return;
  heard_.insert(heard_.end(), chunk.begin(), chunk.begin() + n);
  while (take_request()) {
  }
}

bool RplidarEmulator::take_request() {
  heard_.erase(heard_.begin(), std::find(heard_.begin(), heard_.end(), 0xA5));
  if (heard_.size() < 2) return false;
  const std::uint8_t command = heard_[1];
  if (command < 0x80) {
    heard_.erase(heard_.begin(), heard_.begin() + 2);
    answer(command, {});
    return true;
  }
  if (heard_.size() < 3 || heard_.size() < 4U + heard_[2]) return false;
  const auto payload_end = heard_.begin() + 3 + heard_[2];
  std::uint8_t sum = 0;
  for (auto it = heard_.begin(); it != payload_end; ++it) sum = static_cast<std::uint8_t>(sum ^ *it);
  const bool good = sum == *payload_end;
  const PacketBytes payload(heard_.begin() + 3, payload_end);
  heard_.erase(heard_.begin(), payload_end + 1);
  if (good) answer(command, payload);
  return true;
}

void RplidarEmulator::send(const PacketBytes& bytes) {
  // What does not fit is lost, as on a line that nobody reads.
  if (::write(fd_, bytes.data(), bytes.size()) < 0) return;
}

Duration RplidarEmulator::sample_time() const { return from_seconds(1e-6 * stream_->mode.sample_us); }

/// When the last byte of the next packet will have come.
Time RplidarEmulator::due() const {
  const std::uint8_t answer = stream_->mode.answer;
  const auto last = stream_->samples + samples_in(answer) - 1;
  const Duration sending = from_seconds(10.0 * static_cast<double>(packet_size(answer)) / kind_.baud);
  return stream_->begin + sample_time() * last + sample_time() * 3 / 2 + sending + kAdapter;
}

void RplidarEmulator::send_due_packets() {
  const Time now = clock_.now();  // what comes due meanwhile is for the next turn: it may never be done else
  if (stream_ && now > due() + kLongestBehind) {
    const int n = samples_in(stream_->mode.answer);
    stream_->samples += n * ((now - due()) / (sample_time() * n));
  }
  while (stream_ && now >= due()) {
    PacketBytes bytes = next_packet();
    if (silent_ || turns_per_s_ == 0.0) continue;
    if (std::exchange(stream_->cut_first, false))
      bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() / 2));
    if (drops_ > 0) {
      --drops_;
      ++faults_done_;
      bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() / 2));
    } else if (flips_ > 0) {
      --flips_;
      ++faults_done_;
      bytes[bytes.size() - 1] ^= 0x10;
    }
    send(bytes);
  }
}

}  // namespace dynslam::test
