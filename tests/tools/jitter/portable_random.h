// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "base/angles.h"

namespace dynslam::jitter {

/// Random numbers that every standard library draws alike: it says what the engine gives, but not what its
/// distributions make of that. Streams of one seed have nothing to do with each other.
class PortableRandom {
 public:
  PortableRandom(std::uint64_t seed, std::uint32_t stream) {
    std::seed_seq mixed{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32), stream};
    engine_.seed(mixed);
  }

  /// Even over [0, 1).
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double uniform(double from, double to) { return from + (to - from) * uniform(); }

  /// Normal, of mean 0 and deviation 1 (Box-Muller, one of the two).
  double gauss() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(kTwoPi * uniform());
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace dynslam::jitter
