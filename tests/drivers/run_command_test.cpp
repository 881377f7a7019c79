// SPDX-License-Identifier: MIT
// `dynslam run` and `dynslam probe` as processes of their own, on hardware that is emulated in this one.
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <sstream>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "drivers/emulated_hardware.h"
#include "sim/small_world.h"

namespace dynslam::test {
namespace {

using ::testing::HasSubstr;

constexpr double kPatience_s = 30.0;

/// A command in a process of its own, stopped at the end.
class Process {
 public:
  /// Not by way of a shell: what is preloaded into it may not bear that.
  Process(std::vector<std::string> words, std::string said) : said_(std::move(said)) {
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    pid_ = ::fork();
    if (pid_ != 0) return;
    const int out = ::open(said_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
    ::dup2(out, STDOUT_FILENO);
    ::dup2(out, STDERR_FILENO);
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  ~Process() {
    if (pid_ > 0) ::kill(pid_, SIGKILL), ::waitpid(pid_, nullptr, 0);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void terminate() const { ::kill(pid_, SIGTERM); }
  /// Its exit code, once it has ended; that of a shell where a signal ended it.
  std::optional<int> ended() {
    int status = 0;
    if (pid_ <= 0 || ::waitpid(pid_, &status, WNOHANG) != pid_) return std::nullopt;
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  std::string said() const {
    std::ifstream in(said_);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
  }

 private:
  std::string said_;
  pid_t pid_ = -1;
};

class RunCommand : public ::testing::Test {
 protected:
  /// The lines of an emulated chip can only be had within its own process.
  std::string config_file() {
    Config config = hardware_.config();
    config.hardware.gpio = {};
    config.server.port = 0;
    const std::string path = hardware_.folder() + "/dynslam.toml";
    std::ofstream(path) << config_reference(config);
    return path;
  }
  Process dynslam(const std::string& command) {
    return {{DYNSLAM_BINARY, command, "--config", config_file()}, hardware_.folder() + "/said.txt"};
  }
  bool comes_true(const std::function<bool()>& what) const {
    const Time end = hardware_.clock.now() + from_seconds(kPatience_s);
    while (hardware_.clock.now() < end) {
      if (what()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
  }

  EmulatedHardware hardware_{bare_room()};
};

TEST_F(RunCommand, BringsAllDevicesToLifeAndLeavesThemAtRest) {
  Process run = dynslam("run");
  EXPECT_TRUE(comes_true([&] { return hardware_.motors.failsafe_on(); })) << run.said();
  EXPECT_TRUE(comes_true([&] { return hardware_.imu.mode() == 0x08; })) << run.said();
  EXPECT_TRUE(comes_true([&] { return hardware_.lidar.measures(); })) << run.said();
  EXPECT_TRUE(comes_true([&] { return run.said().find("http://localhost:") != std::string::npos; }));
  EXPECT_THAT(run.said(), testing::Not(HasSubstr("critical")));
  run.terminate();
  std::optional<int> code;
  EXPECT_TRUE(comes_true([&] { return (code = run.ended()).has_value(); }));
  EXPECT_EQ(code, 0) << run.said();
  EXPECT_TRUE(comes_true([&] { return !hardware_.lidar.turns(); })) << "its motor is left on";
  EXPECT_EQ(hardware_.motors.power_a(), 0.0);
}

TEST_F(RunCommand, ThatIsKilledLeavesTheMotorsToTheirFailsafeAndCanBeginAgain) {
  {
    Process run = dynslam("run");
    EXPECT_TRUE(comes_true([&] { return hardware_.lidar.measures() && hardware_.motors.failsafe_on(); }))
        << run.said();
  }
  EXPECT_TRUE(hardware_.motors.failsafe_on());
  Process again = dynslam("run");
  const int resets = hardware_.imu.resets();
  EXPECT_TRUE(comes_true([&] { return hardware_.imu.resets() > resets; })) << again.said();
  EXPECT_TRUE(comes_true([&] { return hardware_.imu.mode() == 0x08 && hardware_.lidar.measures(); }))
      << again.said();
}

TEST_F(RunCommand, ProbeTellsItAllAndEndsWell) {
  Process probe = dynslam("probe");
  std::optional<int> code;
  EXPECT_TRUE(comes_true([&] { return (code = probe.ended()).has_value(); }));
  EXPECT_EQ(code, 0) << probe.said();
  for (const char* words : {"lidar    A3M1", "imu      BNO055", "motors   ThunderBorg", "camera   none"})
    EXPECT_THAT(probe.said(), HasSubstr(words));
}

TEST_F(RunCommand, ProbeThatIsInterruptedLeavesTheLidarAtRest) {
  hardware_.lidar.set_spin_up(std::chrono::seconds(5));
  Process probe = dynslam("probe");
  EXPECT_TRUE(comes_true([&] { return hardware_.lidar.turns(); })) << probe.said();
  probe.terminate();
  std::optional<int> code;
  EXPECT_TRUE(comes_true([&] { return (code = probe.ended()).has_value(); }));
  EXPECT_EQ(code, 128 + SIGTERM) << probe.said();
  EXPECT_TRUE(comes_true([&] { return !hardware_.lidar.turns(); })) << "its motor is left on";
}

}  // namespace
}  // namespace dynslam::test
