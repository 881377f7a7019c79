// SPDX-License-Identifier: MIT
// The robot by itself in simulated buildings, real SLAM in the loop. A mission that fails leaves all of its
// files (a recording, the map's picture) in MISSIONS_OUT, by default build/missions beside the tests.
// For a long run: DYNSLAM_WORLDS (names with commas, or "all"), in each DYNSLAM_SEEDS seeds from DYNSLAM_SEED
// on, with DYNSLAM_GOALS goals for each. A table of all missions comes last.
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "exploration_yardstick.h"
#include "mission_table.h"
#include "sim/world.h"

namespace dynslam {
namespace {

namespace fs = std::filesystem;

/// Of slam.trusted_range_m.
constexpr double kTrustedRange_m = 12.0;
/// So much more time than a robot that knows the world.
constexpr double kMostOfYardstick = 1.6;
/// Where nearly all is seen from the start, a robot must still make sure of it.
constexpr double kLeastToExplore_s = 30.0;

int number_from(const char* variable, int otherwise) {
  const char* text = std::getenv(variable);
  return text ? std::atoi(text) : otherwise;
}

struct MissionCase {
  std::string world;
  int seed;
};

void PrintTo(const MissionCase& tested, std::ostream* out) { *out << tested.world << " " << tested.seed; }

std::vector<MissionCase> cases() {
  const char* chosen = std::getenv("DYNSLAM_WORLDS");
  // One seed says little: of 80 in the apartment three take longer than they may, seed 9 1.8 times the
  // yardstick.
  if (!chosen) return {{"empty", 1}, {"apartment", 1}};
  std::vector<std::string> worlds;
  std::istringstream names(chosen);
  for (std::string name; std::getline(names, name, ',');) worlds.push_back(name);
  if (worlds == std::vector<std::string>{"all"}) worlds = builtin_world_names();
  const int first = number_from("DYNSLAM_SEED", 1), seeds = number_from("DYNSLAM_SEEDS", 1);
  std::vector<MissionCase> cases;
  for (const std::string& world : worlds) {
    for (int seed = first; seed < first + seeds; ++seed) cases.push_back({world, seed});
  }
  return cases;
}

/// Of all that this program flew.
class TableAtTheEnd : public ::testing::Environment {
 public:
  void TearDown() override { std::cout << table.text(); }
  static inline MissionTable table;
};
const auto* const table_at_the_end = ::testing::AddGlobalTestEnvironment(new TableAtTheEnd);

class Missions : public ::testing::TestWithParam<MissionCase> {
 protected:
  /// What report.json says of a mission; its files stay only where the test fails.
  nlohmann::json fly(const std::string& mission) {
    const auto& [world, seed] = GetParam();
    const char* out = std::getenv("MISSIONS_OUT");
    folder_ = fs::path(out ? out : "missions") / (world + "-" + mission + "-" + std::to_string(seed));
    fs::create_directories(folder_);
    const std::string command = std::string(DYNSLAM_BINARY) + " sim --headless --speed 0 --world " + world +
                                " --mission " + mission + " --seed " + std::to_string(seed) +
                                " --duration 14400 --out '" + folder_.string() + "' >'" +
                                (folder_ / "said.txt").string() + "' 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
    std::ifstream in(folder_ / "report.json");
    const nlohmann::json report = nlohmann::json::parse(in, nullptr, false);
    if (report.is_discarded()) return {};
    RecordProperty("report", report["mission"].dump());
    return report["mission"];
  }
  void TearDown() override {
    if (!HasFailure()) fs::remove_all(folder_);
  }

 private:
  fs::path folder_;
};

TEST_P(Missions, ExploresAllThatCanBeReached) {
  const auto& [world, seed] = GetParam();
  const double yardstick_s = exploration_yardstick(load_world(world), kTrustedRange_m).time_s;
  const nlohmann::json mission = fly("explore");
  TableAtTheEnd::table.add_exploration(world, seed, yardstick_s, mission);
  ASSERT_TRUE(mission.is_object());
  const double time_s = mission["time_s"];
  RecordProperty("times_the_yardstick", std::to_string(time_s / yardstick_s));
  EXPECT_EQ(mission["result"], "done") << mission["reason"];
  EXPECT_EQ(mission["contacts"], 0) << mission["contact_places"].dump(2);
  EXPECT_GT(mission["reachable_floor_mapped"].get<double>(), 0.98);
  EXPECT_LE(time_s, std::max(kLeastToExplore_s, kMostOfYardstick * yardstick_s)) << yardstick_s << " s";
}

TEST_P(Missions, ReachesPlacesDrawnByLotOrRightlySaysThatItCannot) {
  const auto& [world, seed] = GetParam();
  const int goals = number_from("DYNSLAM_GOALS", 4);
  const nlohmann::json mission = fly("goals:" + std::to_string(goals));
  TableAtTheEnd::table.add_goals(world, seed, goals, mission);
  ASSERT_TRUE(mission.is_object());
  EXPECT_EQ(mission["result"], "done") << mission["reason"];
  EXPECT_EQ(mission["contacts"], 0) << mission["contact_places"].dump(2);
  EXPECT_EQ(mission["goals"]["tried"], goals);
  EXPECT_LE(mission["goals"]["failed"].get<double>(), 0.01 * goals) << mission["failures"].dump(2);
  EXPECT_LE(mission["longest_wait_s"].get<double>(), 10.0) << mission["longest_wait_at"].dump(2);
  EXPECT_LT(mission["reversals_per_m"].get<double>(), 3.0);
}

INSTANTIATE_TEST_SUITE_P(Worlds, Missions, ::testing::ValuesIn(cases()), [](const auto& tested) {
  std::string name;
  for (const char c : tested.param.world) name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return name + "_" + std::to_string(tested.param.seed);
});

}  // namespace
}  // namespace dynslam
