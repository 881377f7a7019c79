// SPDX-License-Identifier: MIT
#include "caretaker.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace dynslam {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using testing::HasSubstr;

/// A folder that looks like the root of a Raspberry Pi.
class CaretakerTest : public testing::Test {
 protected:
  CaretakerTest() {
    std::string name = fs::temp_directory_path() / "caretaker-XXXXXX";
    root_ = mkdtemp(name.data());
    fs::create_directories(root_ / "sys/devices/platform/soc/soc:firmware");
    say_flags("0");
  }
  ~CaretakerTest() override { fs::remove_all(root_); }

  void say_flags(const std::string& hex) {
    std::ofstream(root_ / "sys/devices/platform/soc/soc:firmware/get_throttled.new") << hex << '\n';
    fs::rename(root_ / "sys/devices/platform/soc/soc:firmware/get_throttled.new",
               root_ / "sys/devices/platform/soc/soc:firmware/get_throttled");
  }
  bool comes_true(const std::function<bool()>& what) {
    for (int i = 0; i < 2000 && !what(); ++i) std::this_thread::sleep_for(milliseconds(5));
    return what();
  }
  std::string trouble() const {
    const auto health = ports_.computer_health.get().value;
    return health ? health->trouble : "nothing told yet";
  }

  fs::path root_;
  RunningClock clock_;
  Ports ports_;
};

TEST_F(CaretakerTest, TellsOfALowSupplyAndOfItsEnd) {
  const Caretaker caretaker(ports_, clock_, Config(), root_);
  EXPECT_TRUE(comes_true([&] { return trouble().empty(); }));
  EXPECT_FALSE(ports_.supply_low);
  say_flags("50005");
  EXPECT_TRUE(comes_true([&] { return ports_.supply_low.load(); }));
  EXPECT_TRUE(comes_true([&] { return !trouble().empty(); }));
  EXPECT_THAT(trouble(), HasSubstr("its supply is under 4.63 V"));
  say_flags("50000");
  EXPECT_TRUE(comes_true([&] { return !ports_.supply_low; }));
}

TEST_F(CaretakerTest, HasNothingToSayOfAComputerThatTellsNothing) {
  {
    const Caretaker caretaker(ports_, clock_, Config(), root_ / "nowhere");
    std::this_thread::sleep_for(milliseconds(100));
  }
  EXPECT_EQ(trouble(), "nothing told yet");
  EXPECT_FALSE(ports_.supply_low);
}

}  // namespace
}  // namespace dynslam
