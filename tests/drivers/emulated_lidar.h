// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace dynslam::test {

/// The types of answer that carry measurements.
inline constexpr std::uint8_t kStandard = 0x81, kExpress = 0x82, kHq = 0x83, kUltra = 0x84, kDense = 0x85,
                              kUltraDense = 0x86;

/// A kind of RPLIDAR.
struct EmulatedLidar {
  struct Mode {
    std::string name;
    double sample_us;
    double max_range_m;
    std::uint8_t answer;
  };
  std::uint8_t model;
  std::uint16_t firmware;  ///< major in the high byte
  std::uint8_t hardware;
  int baud;
  std::vector<Mode> modes;  ///< by id; without any it does not know how to tell them
  std::uint16_t typical = 0;
  bool has_accessory_board = false;
};
EmulatedLidar emulated_a1();      ///< of old firmware
EmulatedLidar emulated_a1_new();  ///< tells its modes
EmulatedLidar emulated_a2();
EmulatedLidar emulated_a3();
EmulatedLidar emulated_s1();
EmulatedLidar emulated_c1();

/// Of the packets with measurements, by the type of answer.
std::size_t packet_size(std::uint8_t answer);
int samples_in(std::uint8_t answer);

}  // namespace dynslam::test
