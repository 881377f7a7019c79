// SPDX-License-Identifier: MIT
#include "run_command.h"

#include <csignal>
#include <cstdlib>
#include <optional>

#include <spdlog/spdlog.h>

#include "caretaker.h"
#include "log_tap.h"
#include "real_devices.h"
#include "robot/robot.h"
#include "robot/steady_memory.h"
#include "robot_config.h"
#include "serve.h"
#include "supervisor.h"

namespace dynslam {
namespace {

volatile std::sig_atomic_t stop_signal = 0;
void on_signal(int signal) { stop_signal = signal; }

constexpr Duration kLookEvery = std::chrono::milliseconds(100);
/// The control's thread lives while it decided something so short ago.
constexpr Duration kAlive = std::chrono::milliseconds(500);
/// Ten scans a second, an hour of them.
constexpr std::size_t kPathKept = 36000;

bool is_alive(const Ports& ports, const Clock& clock) {
  const auto drive = ports.drive.get().value;
  return drive && clock.now() - drive->time < kAlive;
}

/// Until somebody or something asks for the end.
void watch(const Robot& robot, const Ports& ports, const Clock& clock, Supervisor& supervisor) {
  while (stop_signal == 0 && !robot.wait(clock.steady(clock.now() + kLookEvery)))
    if (is_alive(ports, clock)) supervisor.alive();
}

}  // namespace

int run_robot(const Config& config) {
  keep_memory_steady();
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  // A terminal that goes away ends the robot too, unless it was started by nohup.
  if (std::signal(SIGHUP, on_signal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  const RunningClock clock;
  Supervisor supervisor;
  RobotConfig own = robot_config(config);
  own.timely_first = true;
  Robot robot(make_real_devices(config, clock), own, clock);
  robot.slam().keep_path(kPathKept);
  const LogTap tap(robot.ports(), clock);
  for (const std::string& warning : config.warnings) spdlog::warn("{}", warning);
  std::optional<Caretaker> caretaker(std::in_place, robot.ports(), clock, config);
  ServeOptions options;
  if (!config.state.folder.empty()) options.state_folder = config.state.folder;
  std::optional<Serving> serving(std::in_place, robot.ports(), clock, config, options);
  robot.start();
  supervisor.ready();
  watch(robot, robot.ports(), clock, supervisor);

  supervisor.stopping();
  const Robot::Ending ending = robot.stop();
  if (ending.hangs) {
    spdlog::critical("a device does not come back; the motors are off");
    std::_Exit(1);
  }
  serving.reset();
  caretaker.reset();
  robot.finish();
  if (!ending.trouble.empty()) spdlog::critical("{}", ending.trouble);
  return ending.trouble.empty() ? 0 : 1;
}

}  // namespace dynslam
