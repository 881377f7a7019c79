// SPDX-License-Identifier: MIT
// The robot by itself in simulated buildings, real SLAM in the loop. A mission that fails leaves all of its
// files (a recording, the map's picture) in MISSIONS_OUT, by default build/missions beside the tests.
// DYNSLAM_GOALS and DYNSLAM_SEEDS say how many goals and seeds there are for each world, for a long run.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace dynslam {
namespace {

namespace fs = std::filesystem;

int number_from(const char* variable, int otherwise) {
  const char* text = std::getenv(variable);
  return text ? std::atoi(text) : otherwise;
}

struct MissionCase {
  const char* world;
  int first_seed;
  double most_explore_s;
};

class Missions : public ::testing::TestWithParam<MissionCase> {
 protected:
  /// What report.json says of a mission; its files stay only where the test fails.
  nlohmann::json fly(const std::string& mission, int seed) {
    const char* out = std::getenv("MISSIONS_OUT");
    folder_ = fs::path(out ? out : "missions") /
              (std::string(GetParam().world) + "-" + mission + "-" + std::to_string(seed));
    fs::create_directories(folder_);
    const std::string command = std::string(DYNSLAM_BINARY) + " sim --headless --speed 0 --world " +
                                GetParam().world + " --mission " + mission + " --seed " +
                                std::to_string(seed) + " --duration 7200 --out '" + folder_.string() +
                                "' >'" + (folder_ / "said.txt").string() + "' 2>&1";
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
  for (int seed = GetParam().first_seed; seed < GetParam().first_seed + number_from("DYNSLAM_SEEDS", 1);
       ++seed) {
    const nlohmann::json mission = fly("explore", seed);
    ASSERT_TRUE(mission.is_object());
    EXPECT_EQ(mission["result"], "done") << mission["reason"];
    EXPECT_EQ(mission["contacts"], 0);
    EXPECT_GT(mission["reachable_floor_mapped"].get<double>(), 0.98);
    EXPECT_LT(mission["time_s"].get<double>(), GetParam().most_explore_s);
  }
}

TEST_P(Missions, ReachesPlacesDrawnByLotOrRightlySaysThatItCannot) {
  const int goals = number_from("DYNSLAM_GOALS", 4);
  for (int seed = GetParam().first_seed; seed < GetParam().first_seed + number_from("DYNSLAM_SEEDS", 1);
       ++seed) {
    const nlohmann::json mission = fly("goals:" + std::to_string(goals), seed);
    ASSERT_TRUE(mission.is_object());
    EXPECT_EQ(mission["result"], "done") << mission["reason"];
    EXPECT_EQ(mission["contacts"], 0);
    EXPECT_EQ(mission["goals"]["tried"], goals);
    EXPECT_LE(mission["goals"]["failed"].get<double>(), 0.01 * goals) << mission["failures"].dump(2);
    EXPECT_LT(mission["longest_wait_s"].get<double>(), 30.0);
    EXPECT_LT(mission["reversals_per_m"].get<double>(), 3.0);
  }
}

INSTANTIATE_TEST_SUITE_P(Worlds, Missions,
                         ::testing::Values(MissionCase{"empty", 1, 30}, MissionCase{"apartment", 3, 500}),
                         [](const auto& tested) { return std::string(tested.param.world); });

}  // namespace
}  // namespace dynslam
