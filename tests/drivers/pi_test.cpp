// SPDX-License-Identifier: MIT
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/pi/pi_watch.h"

namespace dynslam {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A folder that looks like a computer's root.
class Computer : public testing::Test {
 protected:
  Computer() {
    std::string name = fs::temp_directory_path() / "pi-XXXXXX";
    root_ = mkdtemp(name.data());
  }
  ~Computer() override { fs::remove_all(root_); }
  void write(const std::string& path, const std::string& text) {
    fs::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << text;
  }
  PiState read() const { return PiWatch(root_).read(); }

  fs::path root_;
};

constexpr const char* kFlags = "sys/devices/platform/soc/soc:firmware/get_throttled";
constexpr const char* kTemperature = "sys/class/thermal/thermal_zone0/temp";

TEST_F(Computer, ThatTellsNothingIsNoError) {
  const PiState state = read();
  EXPECT_FALSE(state.flags);
  EXPECT_FALSE(state.under_voltage);
  EXPECT_FALSE(state.temperature_c);
  EXPECT_THAT(state.advice(), IsEmpty());
  EXPECT_EQ(PiWatch(root_).model(), "");
  EXPECT_FALSE(PiWatch(root_ / "nowhere").read().flags);
}

TEST_F(Computer, ThatIsWellGivesNoAdvice) {
  write(kFlags, "0\n");
  write(kTemperature, "48312\n");
  const PiState state = read();
  EXPECT_EQ(state.under_voltage, false);
  EXPECT_DOUBLE_EQ(state.temperature_c.value(), 48.312);
  EXPECT_THAT(state.advice(), IsEmpty());
}

TEST_F(Computer, TellsTheFlagsOneByOne) {
  // 0x50005: bits 0 and 2 now, 16 and 18 since the start.
  write(kFlags, "50005\n");
  const PiFlags flags = read().flags.value();
  EXPECT_TRUE(flags.under_voltage());
  EXPECT_TRUE(flags.throttled());
  EXPECT_FALSE(flags.frequency_capped());
  EXPECT_FALSE(flags.soft_temperature_limit());
  EXPECT_TRUE(flags.was_slowed());
  EXPECT_THAT(read().advice(),
              ElementsAre(HasSubstr("its supply is under 4.63 V"), HasSubstr("slowed down")));
}

TEST_F(Computer, RemembersWhatTheFirmwareRemembers) {
  write(kFlags, "0x10000");
  EXPECT_EQ(read().under_voltage, false);
  EXPECT_THAT(read().advice(), ElementsAre(HasSubstr("was under 4.63 V")));
  write(kFlags, "0x40000");
  EXPECT_THAT(read().advice(), ElementsAre(HasSubstr("was slowed down")));
}

TEST_F(Computer, FindsTheFlagsWhereverTheFirmwareStands) {
  write("sys/bus/platform/devices/other/get_throttled", "f\n");
  write("sys/bus/platform/devices/soc@107c000000:firmware/get_throttled", "8\n");
  EXPECT_EQ(read().flags.value().bits(), 8U);
  EXPECT_THAT(read().advice(), ElementsAre(HasSubstr("warm")));
}

TEST_F(Computer, TakesTheVoltagesAlarmWhereThereAreNoFlags) {
  write("sys/class/hwmon/hwmon0/name", "cpu_thermal\n");
  write("sys/class/hwmon/hwmon0/in0_lcrit_alarm", "0\n");
  write("sys/class/hwmon/hwmon1/name", "rpi_volt\n");
  write("sys/class/hwmon/hwmon1/in0_lcrit_alarm", "1\n");
  EXPECT_FALSE(read().flags);
  EXPECT_EQ(read().under_voltage, true);
  EXPECT_THAT(read().advice(), ElementsAre(HasSubstr("its supply is under 4.63 V")));
}

TEST_F(Computer, WarnsBeforeItIsTooHot) {
  write(kTemperature, "69999\n");
  EXPECT_THAT(read().advice(), IsEmpty());
  write(kTemperature, "70000\n");
  EXPECT_THAT(read().advice(), ElementsAre(HasSubstr("70 degrees")));
  write(kTemperature, "80000\n");
  EXPECT_THAT(read().advice(), ElementsAre(HasSubstr("80 degrees")));
}

TEST_F(Computer, NamesItsModel) {
  write("proc/device-tree/model", std::string("Raspberry Pi Zero 2 W Rev 1.0\0", 30));
  EXPECT_EQ(PiWatch(root_).model(), "Raspberry Pi Zero 2 W Rev 1.0");
}

TEST(PiFiles, NonsenseIsNothing) {
  for (const char* text : {"", "\n", "0x", "zero", "12345678901", "-1", "5 0"})
    EXPECT_FALSE(parse_flags(text)) << text;
  for (const char* text : {"", "warm", "48.3", "200000", "-60000", "99999999999"})
    EXPECT_FALSE(parse_temperature_c(text)) << text;
  EXPECT_DOUBLE_EQ(parse_temperature_c("-1500\n").value(), -1.5);
}

}  // namespace
}  // namespace dynslam
