// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "pipe/clock.h"
#include "tests/drivers/emulated_lidar.h"
#include "tests/drivers/rplidar_encoder.h"

namespace dynslam::test {

/// An RPLIDAR at a pseudo-terminal, in a thread of its own: answers, spins up, and measures what a function
/// tells it, paced as on a real line. Its port is a link in a folder, as udev makes them. All its methods can
/// be called at any time.
class RplidarEmulator {
 public:
  /// How far it is to what the lidar sees at this angle (counter-clockwise, lidar frame) and time, metres;
  /// infinite: nothing. Called by the emulator's thread.
  using Ranger = std::function<double(double angle_rad, Time when)>;

  /// Plugged in, ready to answer. Clock and folder must outlive it.
  RplidarEmulator(EmulatedLidar kind, const Clock& clock, std::string folder, Ranger ranger);
  ~RplidarEmulator();
  RplidarEmulator(const RplidarEmulator&) = delete;
  RplidarEmulator& operator=(const RplidarEmulator&) = delete;

  std::string port() const;

  void unplug();
  /// As a new port, which answers after a while.
  void plug_in();
  /// Out of the packet that comes next; how often so far.
  void drop_byte();
  void flip_bit();
  int faults_done() const;
  void be_silent(bool silent);
  /// Stops until it is reset; a lasting one comes again.
  void stop_to_protect(bool lasting);
  void set_spin_up(Duration length);
  /// Writes so much of other things before the answer that announces measurements, and begins these in
  /// mid-packet.
  void begin_untidily();

  bool turns() const;  ///< whether the motor does
  bool measures() const;
  int resets() const;

 private:
  struct Stream {
    EmulatedLidar::Mode mode;
    Time begin;            ///< of the first sample
    std::int64_t samples;  ///< sent so far
    bool cut_first;        ///< only the rest of the first packet is sent
  };

  void run(const std::stop_token& stop);
  void open_port();
  void close_port();
  void listen();
  bool take_request();
  void answer(std::uint8_t command, const PacketBytes& payload);
  void answer_conf(const PacketBytes& payload);
  void begin_stream(const EmulatedLidar::Mode& mode);
  void send(const PacketBytes& bytes);
  void reply(std::uint8_t type, const PacketBytes& payload);
  void send_due_packets();
  Time due() const;
  Duration sample_time() const;
  PacketBytes next_packet();
  void set_motor(double turns_per_s);
  double turned_deg(Time t) const;
  double mm_at(double angle_deg, Time t) const;
  bool hears() const;

  EmulatedLidar kind_;
  const Clock& clock_;
  std::string folder_;
  Ranger ranger_;
  mutable std::mutex mutex_;
  int fd_ = -1;
  PacketBytes heard_;
  Time awake_at_;
  std::optional<Time> greet_at_;
  double turns_per_s_ = 0.0;
  Time motor_at_;  ///< when it began to turn
  Duration spin_up_ = std::chrono::milliseconds(500);
  std::optional<Stream> stream_;
  std::uint8_t health_ = 0;
  bool lasting_ = false, silent_ = false, untidy_ = false;
  int drops_ = 0, flips_ = 0, faults_done_ = 0, resets_ = 0;
  std::jthread thread_;
};

}  // namespace dynslam::test
