// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "drivers/i2c_chip.h"

typedef struct _UMockdevTestbed UMockdevTestbed;
typedef struct _UMockdevIoctlBase UMockdevIoctlBase;
typedef struct _UMockdevIoctlClient UMockdevIoctlClient;

namespace dynslam::test {

/// Buses /dev/i2c-N that only this process and its children see, by umockdev, whose library has to be loaded
/// before all others (mocked_main.cpp does that). It answers the system calls of i2c-dev: I2C_SLAVE,
/// I2C_FUNCS, I2C_TIMEOUT, I2C_SMBUS, I2C_RDWR, read and write. One at a time; make it before the drivers.
class MockI2cBuses {
 public:
  MockI2cBuses();
  ~MockI2cBuses();
  MockI2cBuses(const MockI2cBuses&) = delete;
  MockI2cBuses& operator=(const MockI2cBuses&) = delete;

  /// Adds /dev/i2c-NUMBER with nothing on it. `software` is what its functions say it is.
  void add_bus(int number, bool software = false);
  /// Wires a chip; null takes it off. The chip must outlive its place here.
  void plug(int bus, int address, I2cChip* chip);
  /// The test bed that they stand in, for other emulated devices.
  UMockdevTestbed* bed() { return testbed_; }
  /// How many ioctls of I2C_RDWR there were.
  int long_transfers() const;

 private:
  struct Bus {
    bool software = false;
    std::map<int, I2cChip*> chips;
    UMockdevIoctlBase* handler = nullptr;
  };
  struct Answer {
    long result = 0;
    int error = 0;
  };

  static int on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, void* self);
  static int on_read(UMockdevIoctlBase*, UMockdevIoctlClient* client, void* self);
  static int on_write(UMockdevIoctlBase*, UMockdevIoctlClient* client, void* self);
  Answer ioctl(UMockdevIoctlClient* client);
  Answer smbus(UMockdevIoctlClient* client);
  Answer transfers(UMockdevIoctlClient* client);
  I2cChip* chip_of(UMockdevIoctlClient* client);
  I2cChip* chip_at(UMockdevIoctlClient* client, int address);

  mutable std::mutex mutex_;
  UMockdevTestbed* testbed_;
  std::map<std::string, Bus> buses_;               ///< by device file
  std::map<UMockdevIoctlClient*, int> addresses_;  ///< that each open file talks to
  int long_transfers_ = 0;
};

}  // namespace dynslam::test
