// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace dynslam {

/// What report.json says of missions, as a table for people: a row each, and all goals together.
class MissionTable {
 public:
  /// `wanted` goals; those that it did not come to count as failed.
  void add_goals(const std::string& world, int seed, int wanted, const nlohmann::json& mission);
  void add_exploration(const std::string& world, int seed, double yardstick_s, const nlohmann::json& mission);
  /// Empty when there was nothing.
  std::string text() const;

 private:
  struct Sum {
    int wanted = 0, right = 0, contacts = 0, unseen = 0;
    double longest_wait_s = 0.0;
  };
  std::vector<std::string> explorations_, goals_;
  Sum sum_;
};

}  // namespace dynslam
