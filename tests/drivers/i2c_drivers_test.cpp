// SPDX-License-Identifier: MIT
// IMU and motor board together, each on its bus and in its thread, by the real clock.
#include <atomic>
#include <cstdlib>
#include <new>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/bno055/bno055.h"
#include "drivers/bno055_emulator.h"
#include "drivers/mock_i2c_bus.h"
#include "drivers/thunderborg/thunderborg.h"
#include "drivers/thunderborg_emulator.h"

namespace {
thread_local long allocations = 0;
}  // namespace

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they have their own
void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
#endif

namespace dynslam {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

class I2cDriversTest : public ::testing::Test {
 protected:
  I2cDriversTest() {
    buses_.add_bus(1);
    buses_.add_bus(3, true);
    buses_.plug(1, 0x15, &board_);
    buses_.plug(3, 0x28, &chip_);
  }
  std::vector<ImuSample> read_imu(Bno055& imu, std::size_t n) {
    std::vector<ImuSample> samples;
    samples.reserve(n);
    const Time end = clock_.now() + seconds(30);
    while (samples.size() < n && clock_.now() < end) {
      if (const auto sample = imu.next(clock_.now() + milliseconds(100))) samples.push_back(*sample);
    }
    return samples;
  }

  RunningClock clock_;
  test::Bno055Emulator chip_{[this] { return clock_.now(); }, [] { return test::TrueMotion{}; }};
  test::ThunderBorgEmulator board_{[this] { return clock_.now(); }};
  test::MockI2cBuses buses_;
};

TEST_F(I2cDriversTest, WorkAtTheSameTime) {
  std::atomic<bool> done{false};
  std::thread control([&] {
    ThunderBorg motors({}, clock_);
    while (!done) {
      motors.drive({0.5, -0.5});
      motors.read();
    }
  });
  Bno055 imu({}, clock_);
  const auto samples = read_imu(imu, 10);
  EXPECT_EQ(samples.size(), 10U);
  for (std::size_t i = 1; i < samples.size(); ++i) EXPECT_GT(samples[i].stamp, samples[i - 1].stamp);
  done = true;
  control.join();
  EXPECT_EQ(board_.power_a(), 0.0) << "switched off in the end";
}

TEST_F(I2cDriversTest, TakeNoMemoryWhileAllIsWell) {
  Bno055 imu({}, clock_);
  ThunderBorg motors({}, clock_);
  read_imu(imu, 5);
  for (int i = 0; i < 3; ++i) motors.read();
  const Time end = clock_.now() + milliseconds(1200);  // with a look at the IMU's state
  const long before = allocations;
  while (clock_.now() < end) {
    imu.next(clock_.now() + milliseconds(20));
    motors.drive({0.1, 0.1});
    motors.read();
  }
  EXPECT_LE(allocations - before, 3) << "the first count of a name, such as \"skipped\" on a busy computer";
}

}  // namespace
}  // namespace dynslam
