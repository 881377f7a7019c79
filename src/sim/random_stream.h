// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "base/angles.h"

namespace dynslam {

/// Numbers that depend on the seed and the name of the stream alone (SplitMix64: Steele, Lea and Flood,
/// 2014), so that what one device draws does not change what another does.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::uint64_t stream) : state_(seed) {
    state_ = next() ^ (stream * 0xd1342543de82ef95ULL);
  }

  std::uint64_t next() {
    state_ += 0x9e3779b97f4a7c15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  /// In [0, 1).
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Of mean 0 and deviation 1 (Box and Muller, 1958).
  double normal() {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform())), angle = kTwoPi * uniform();
    spare_ = radius * std::sin(angle);
    has_spare_ = true;
    return radius * std::cos(angle);
  }

 private:
  std::uint64_t state_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

/// A value that wanders about zero (Ornstein and Uhlenbeck): `sigma` in the long run, forgotten after
/// `tau_s`.
class Wandering {
 public:
  Wandering(double sigma, double tau_s) : sigma_(sigma), tau_s_(tau_s) {}
  double step(double dt_s, RandomStream& random) {
    value_ += -value_ * dt_s / tau_s_ + sigma_ * std::sqrt(2.0 * dt_s / tau_s_) * random.normal();
    return value_;
  }

 private:
  double sigma_, tau_s_;
  double value_ = 0.0;
};

}  // namespace dynslam
