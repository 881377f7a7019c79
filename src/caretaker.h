// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <thread>

#include "config.h"
#include "pipe/clock.h"
#include "robot/ports.h"
#include "robot/stop_signal.h"

namespace dynslam {

/// What a robot does beside driving: its status light, and an eye on the computer's own supply and heat; a
/// supply that is too low is told to who drives. A thread of its own, as the firmware may take its time to
/// answer.
class Caretaker {
 public:
  /// Ports and clock must outlive it; `root` is where /sys is.
  Caretaker(Ports& ports, const Clock& clock, const Config& config, std::filesystem::path root = "/");
  ~Caretaker();
  Caretaker(const Caretaker&) = delete;
  Caretaker& operator=(const Caretaker&) = delete;

 private:
  void run();
  void tell_troubles();
  void show_light();
  void look_at_computer();

  struct Things;
  Ports& ports_;
  const Clock& clock_;
  std::unique_ptr<Things> things_;
  StopSignal ends_;
  std::thread thread_;
};

}  // namespace dynslam
