// SPDX-License-Identifier: MIT
#include "machine.h"

#include <fstream>

#include <gtest/gtest.h>

namespace dynslam {
namespace {

namespace fs = std::filesystem;

/// A folder with the files of a computer.
class MadeMachine : public ::testing::Test {
 protected:
  MadeMachine() {
    std::string pattern = fs::temp_directory_path() / "dynslam-test-XXXXXX";
    root_ = mkdtemp(pattern.data());
  }
  ~MadeMachine() override { fs::remove_all(root_); }
  void file(const std::string& path, const std::string& content) const {
    fs::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << content;
  }
  fs::path root_;
};

TEST_F(MadeMachine, IsARaspberryPi) {
  file("proc/device-tree/model", std::string("Raspberry Pi Zero 2 W Rev 1.0\0", 30));
  file("proc/meminfo", "MemTotal:         437132 kB\nMemFree:          123456 kB\n");
  file("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "ondemand\n");
  file("sys/devices/system/cpu/cpu0/cpufreq/cpuinfo_max_freq", "1000000\n");
  file("sys/class/thermal/thermal_zone0/temp", "61224\n");
  file("sys/devices/platform/soc/soc:firmware/get_throttled", "80008\n");
  const Machine machine = this_machine(root_);
  EXPECT_EQ(machine.model, "Raspberry Pi Zero 2 W Rev 1.0");
  EXPECT_EQ(machine.memory_mib, 426);
  EXPECT_EQ(machine.governor, "ondemand");
  EXPECT_EQ(machine.most_mhz, 1000);
  EXPECT_NEAR(machine.temperature_c.value_or(0.0), 61.224, 1e-9);
  EXPECT_EQ(machine.throttled, 0x80008U);
  EXPECT_EQ(machine.advice.size(), 1U);
}

TEST_F(MadeMachine, IsAPc) {
  file("proc/cpuinfo", "processor\t: 0\nmodel\t\t: 17\nmodel name\t: AMD EPYC\nmodel name\t: another\n");
  EXPECT_EQ(this_machine(root_).model, "AMD EPYC");
}

TEST_F(MadeMachine, TellsNothing) {
  const Machine machine = this_machine(root_);
  EXPECT_EQ(machine.model, "");
  EXPECT_EQ(machine.governor, "");
  EXPECT_EQ(machine.most_mhz, 0);
  EXPECT_EQ(machine.memory_mib, 0);
  EXPECT_FALSE(machine.temperature_c || machine.throttled);
  EXPECT_FALSE(machine.architecture.empty());
}

}  // namespace
}  // namespace dynslam
