// SPDX-License-Identifier: MIT
#include "tests/drivers/emulated_lidar.h"

namespace dynslam::test {

std::size_t packet_size(std::uint8_t answer) {
  switch (answer) {
    case kStandard:
      return 5;
    case kUltra:
      return 132;
    case kUltraDense:
      return 170;
    case kHq:
      return 781;
    default:
      return 84;
  }
}

int samples_in(std::uint8_t answer) {
  switch (answer) {
    case kStandard:
      return 1;
    case kExpress:
      return 32;
    case kDense:
      return 40;
    case kUltraDense:
      return 64;
    default:
      return 96;
  }
}

EmulatedLidar emulated_a1() { return {0x18, 0x0114, 5, 115200, {}, 0, false}; }

EmulatedLidar emulated_a1_new() {
  return {0x18,
          0x011D,
          7,
          115200,
          {{"Standard", 508, 12, kStandard}, {"Express", 254, 12, kExpress}, {"Boost", 127, 12, kUltra}},
          2,
          false};
}

EmulatedLidar emulated_a2() {
  return {0x28,
          0x0119,
          6,
          115200,
          {{"Standard", 508, 16, kStandard}, {"Express", 250, 16, kExpress}, {"Boost", 127, 16, kUltra}},
          1,
          true};
}

EmulatedLidar emulated_a3() {
  return {0x31,
          0x011D,
          7,
          256000,
          {{"Standard", 252, 25, kStandard},
           {"Express", 126.5, 25, kExpress},
           {"Boost", 62.90234375, 25, kUltra},
           {"Sensitivity", 62.90234375, 25, kUltra},
           {"Stability", 100, 25, kUltra},
           {"Of the future", 31, 25, 0x99}},
          3,
          true};
}

EmulatedLidar emulated_s1() {
  return {
      0x61, 0x0100, 18, 256000, {{"Standard", 108.6953125, 40, kHq}, {"DenseBoost", 108.6953125, 40, kDense}},
      1,    false};
}

EmulatedLidar emulated_c1() {
  return {0x41, 0x0101, 18, 460800, {{"Standard", 200, 16, kStandard}, {"DenseBoost", 200, 16, kUltraDense}},
          1,    false};
}

}  // namespace dynslam::test
