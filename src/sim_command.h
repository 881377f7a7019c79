// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "config.h"

namespace dynslam {

struct SimOptions {
  std::string world = "apartment";
  double speed = 1.0;  ///< times as fast as life; 0: step by step, as fast as it goes
  std::uint64_t seed = 1;
  std::optional<std::string> out;
  bool headless = false;
  std::optional<double> duration_s;  ///< most of simulated time
  std::string mission;               ///< "tour", "explore" or "goals:N"; empty: waits for a driver, or with
                                     ///< nobody looking on a tour
  std::optional<int> port;           ///< to serve on, in place of the config's
  int laps = 1;                      ///< how often the tour is driven
  std::vector<std::string> faults, kicks;  ///< see sim/disturbance.h
};

/// `dynslam sim`: the whole robot with simulated hardware on a mission. Returns the exit code. Throws
/// InputError for what cannot be used.
int run_sim(const SimOptions& options, const Config& config);

}  // namespace dynslam
