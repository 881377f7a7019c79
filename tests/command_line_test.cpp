// SPDX-License-Identifier: MIT
// The program as a user meets it: run as a process, judged by exit code, stderr and files.
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>

#include "io/byte_source.h"
#include "progress_bar.h"
#include "tools/jitter/trajectory_error.h"
#include "tools/jitter/tum_file.h"

namespace dynslam {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kRecording = DYNSLAM_SOURCE_DIR "/tests/data/mit-csail.clf.gz";

struct Outcome {
  int code = -1;
  std::string out, err;
};

std::string contents(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A folder of its own for each test, gone afterwards.
class CommandLine : public ::testing::Test {
 protected:
  CommandLine() {
    std::string pattern = fs::temp_directory_path() / "dynslam-test-XXXXXX";
    folder_ = mkdtemp(pattern.data());
  }
  ~CommandLine() override { fs::remove_all(folder_); }

  Outcome dynslam(const std::string& arguments) const {
    const std::string err = folder_ / "stderr.txt";
    FILE* pipe = popen((DYNSLAM_BINARY " " + arguments + " 2>" + err).c_str(), "r");
    Outcome outcome;
    std::array<char, 4096> block;
    for (std::size_t n = 0; (n = fread(block.data(), 1, block.size(), pipe)) > 0;)
      outcome.out.append(block.data(), n);
    outcome.code = WEXITSTATUS(pclose(pipe));
    outcome.err = contents(err);
    return outcome;
  }
  std::string file(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  /// The first scans of the recording, as plain text.
  std::string short_log(int lines) const {
    std::istringstream in(plain_log());
    std::string text, line;
    for (int i = 0; i < lines && std::getline(in, line); ++i) text += line + "\n";
    return text;
  }
  static const std::string& plain_log() {
    static const std::string text = [] {
      FILE* pipe = popen(("gzip -dc " + kRecording).c_str(), "r");
      std::string all;
      std::array<char, 65536> block;
      for (std::size_t n = 0; (n = fread(block.data(), 1, block.size(), pipe)) > 0;)
        all.append(block.data(), n);
      pclose(pipe);
      return all;
    }();
    return text;
  }
  static void expect_one_line(const Outcome& o, int code, const std::string& part) {
    EXPECT_EQ(o.code, code) << o.err;
    EXPECT_THAT(o.err, HasSubstr(part));
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
  }

  fs::path folder_;
};

TEST_F(CommandLine, SaysItsVersionAndHelp) {
  EXPECT_THAT(dynslam("--version").out, HasSubstr("dynslam 0."));
  const Outcome help = dynslam("--help");
  EXPECT_EQ(help.code, 0);
  EXPECT_THAT(help.out, HasSubstr("replay"));
}

TEST_F(CommandLine, RefusesWrongUsage) {
  for (const char* wrong : {"", "fly", "replay", "replay a b", "replay a --no-such-option", "sim --seed -1",
                            "sim --seed 1e30", "sim --seed ''", "bench --seed -1"})
    expect_one_line(dynslam(wrong), 2, "dynslam: ");
}

TEST_F(CommandLine, MapsARecordingIntoAFolder) {
  const std::string log = file("short.log", short_log(200));
  const Outcome o = dynslam("replay " + log + " --out " + (folder_ / "a/b").string());
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_EQ(o.err, "") << "no progress bar where stderr is no terminal";
  EXPECT_THAT(o.out, HasSubstr("map.png"));
  for (const char* name :
       {"trajectory.tum", "trajectory_live.tum", "map.pgm", "map.yaml", "map.png", "report.json"}) {
    EXPECT_GT(fs::file_size(folder_ / "a/b" / name), 50U) << name;
  }
  const auto report = nlohmann::json::parse(contents(folder_ / "a/b/report.json"));
  EXPECT_EQ(report["scans"], 96);
  for (const char* key : {"inserted", "skipped", "duration_s", "wall_s", "cpu_s", "peak_rss_bytes",
                          "local_maps", "active_local_maps", "loop_closures"}) {
    EXPECT_TRUE(report[key].is_number()) << key;
  }
  for (const char* key : {"mean", "p50", "p99", "max"})
    EXPECT_TRUE(report["scan_ms"][key].is_number()) << key;
  for (const char* key : {"cell_size_m", "chunks", "bytes"})
    EXPECT_TRUE(report["map"][key].is_number()) << key;
}

TEST_F(CommandLine, GivesTheSameBytesTwice) {
  const std::string log = file("short.log", short_log(400));
  for (const char* out : {"a", "b"})
    EXPECT_EQ(dynslam("replay " + log + " --quiet --out " + (folder_ / out).string()).code, 0);
  for (const char* name : {"trajectory.tum", "trajectory_live.tum", "map.pgm", "map.yaml", "map.png"}) {
    EXPECT_EQ(contents(folder_ / "a" / name), contents(folder_ / "b" / name)) << name;
  }
}

TEST_F(CommandLine, NamesWhatItCannotRead) {
  const std::string out = " --out " + (folder_ / "out").string();
  expect_one_line(dynslam("replay /no/such/file" + out), 2, "/no/such/file");
  expect_one_line(dynslam("replay " + folder_.string() + out), 2, folder_.string());
  expect_one_line(dynslam("replay " + file("empty", "") + out), 2, "empty");
  expect_one_line(dynslam("replay " + file("text", "dear diary\n") + out), 2, "text");
  expect_one_line(dynslam("replay " + file("odometry.log", "ODOM 0 0 0 0 0 0 1 host 1\n") + out), 2, "scan");
  EXPECT_FALSE(fs::exists(folder_ / "out/map.png"));
}

TEST_F(CommandLine, MapsWhatCameBeforeABreak) {
  const std::string whole = contents(kRecording);
  const std::string cut = file("cut.clf.gz", whole.substr(0, whole.size() / 3));
  const Outcome o = dynslam("replay " + cut + " --quiet --out " + (folder_ / "out").string());
  expect_one_line(o, 2, "cut.clf.gz");
  EXPECT_GT(nlohmann::json::parse(contents(folder_ / "out/report.json"))["scans"], 300);
}

TEST_F(CommandLine, LeavesAnOlderResultWhenItFails) {
  fs::create_directory(folder_ / "out");
  std::ofstream(folder_ / "out/map.png") << "older";
  EXPECT_EQ(
      dynslam("replay " + file("none.log", "PARAM a 1 0 h 0\n") + " --out " + (folder_ / "out").string())
          .code,
      2);
  EXPECT_EQ(contents(folder_ / "out/map.png"), "older");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "out"), {}), 1) << "nothing half-written is left";
}

TEST_F(CommandLine, CallsARecordingWithoutAUsableScanByItsName) {
  const std::string blind = file("blind.log", "FLASER 3 81.9 81.9 81.9 0 0 0 0 0 0 1 host 1\n");
  expect_one_line(dynslam("replay " + blind + " --out " + (folder_ / "out").string()), 2, "blind.log");
  EXPECT_FALSE(fs::exists(folder_ / "out/map.png"));
}

TEST_F(CommandLine, FailsWhenItsOutputIsLost) {
  expect_one_line(dynslam("check-config " + file("some.toml", "") + " >/dev/full"), 1, "standard output");
}

TEST_F(CommandLine, TakesNoEmptyNameForAConfig) {
  expect_one_line(dynslam("replay x --config ''"), 2, "config");
}

TEST_F(CommandLine, SaysWhereItCannotWrite) {
  const std::string log = file("short.log", short_log(20));
  expect_one_line(dynslam("replay " + log + " --out " + log + "/sub"), 2, "cannot write");
}

TEST_F(CommandLine, ReportsEveryWrongSettingAtOnce) {
  const Outcome o = dynslam("replay x --set slam.cell_size_m=9 --set slam.nonsense=1");
  EXPECT_EQ(o.code, 2);
  EXPECT_THAT(o.err, HasSubstr("0.5"));
  EXPECT_THAT(o.err, HasSubstr("slam.nonsense"));
}

TEST_F(CommandLine, SimulatesAMissionTwiceTheSame) {
  for (const char* out : {"a", "b"}) {
    const Outcome o = dynslam("sim --world empty --headless --speed 0 --duration 12 --seed 3 --out " +
                              (folder_ / out).string());
    ASSERT_EQ(o.code, 0) << o.err;
    EXPECT_THAT(o.out, HasSubstr("map picture"));
  }
  for (const char* name : {"trajectory.tum", "trajectory_live.tum", "truth.tum", "map.pgm", "map.png",
                           "world.svg", "recording.mcap"}) {
    const std::string bytes = contents(folder_ / "a" / name);
    EXPECT_FALSE(bytes.empty()) << name;
    EXPECT_EQ(bytes, contents(folder_ / "b" / name)) << name;
  }
  const auto mission = nlohmann::json::parse(contents(folder_ / "a" / "report.json"))["mission"];
  EXPECT_EQ(mission["result"], "timeout");
  EXPECT_NEAR(mission["time_s"].get<double>(), 12.0, 0.02);
  EXPECT_GT(mission["distance_m"].get<double>(), 1.0);
  EXPECT_EQ(mission["contacts"], 0);
  EXPECT_EQ(mission["kicks"], 0);
  EXPECT_GT(mission["reachable_floor_mapped"].get<double>(), 0.7);
  EXPECT_LE(mission["reachable_floor_mapped"].get<double>(), 1.0);
}

/// A flat with a person and doors that open and close, and a world by somebody who knew only the page about
/// world files.
TEST_F(CommandLine, KnowsWhereTheSimulatedRobotIs) {
  const auto path = [&](const char* name) {
    FileSource source(folder_ / "out" / name);
    return jitter::read_tum(source);
  };
  for (const std::string world : {"apartment", DYNSLAM_SOURCE_DIR "/tests/data/worlds/clinic.toml"}) {
    const Outcome o = dynslam("sim --headless --speed 0 --duration 60 --seed 4 --world " + world + " --out " +
                              (folder_ / "out").string());
    ASSERT_EQ(o.code, 0) << o.err;
    const auto truth = path("truth.tum"), known = path("trajectory.tum");
    EXPECT_GT(known.size(), 550U) << world;
    EXPECT_LT(jitter::absolute_error_m(known, truth), 0.03) << world;
  }
}

TEST_F(CommandLine, SimulatesWhatGoesWrong) {
  const std::string out = (folder_ / "out").string();
  const Outcome o =
      dynslam("sim --world empty --headless --speed 0 --kick 3:0.5:0 --fault lidar:unplugged:4 --out " + out);
  EXPECT_EQ(o.code, 1) << "a tour without a lidar fails: " << o.out;
  const auto mission = nlohmann::json::parse(contents(folder_ / "out" / "report.json"))["mission"];
  EXPECT_EQ(mission["result"], "stopped");
  EXPECT_THAT(mission["reason"].get<std::string>(), HasSubstr("lidar"));
  EXPECT_LT(mission["time_s"].get<double>(), 120.0);
  EXPECT_EQ(mission["kicks"], 1);
  EXPECT_EQ(mission["contacts"], 0);
}

TEST_F(CommandLine, ReplayOfASimulationGivesItsMap) {
  const std::string own = folder_ / "own", again = folder_ / "again";
  ASSERT_EQ(dynslam("sim --headless --speed 0 --duration 30 --out " + own).code, 0);
  const Outcome o = dynslam("replay " + own + "/recording.mcap --quiet --frames 100000 --out " + again);
  ASSERT_EQ(o.code, 0) << o.err;
  for (const char* name : {"trajectory.tum", "trajectory_live.tum", "map.pgm", "map.yaml"})
    EXPECT_TRUE(contents(own + '/' + name) == contents(again + '/' + name)) << name;
}

TEST_F(CommandLine, SaysWhenTheRecordingOfASimulationIsNotWhole) {
  const std::string out = folder_ / "out";
  fs::create_directory(out);
  std::ofstream(out + "/recording.mcap") << "of an older run";
  const Outcome o =
      dynslam("sim --headless --speed 0 --duration 3 --set recorder.free_floor_mib=1000000 --out " + out);
  EXPECT_EQ(o.code, 0) << "the map is there all the same";
  EXPECT_THAT(o.err, HasSubstr("MiB are to stay free"));
  EXPECT_TRUE(fs::exists(out + "/map.png"));
  EXPECT_FALSE(fs::exists(out + "/recording.mcap")) << "what is there would be of another run";
}

TEST_F(CommandLine, NamesWhatIsWrongWithASimulation) {
  expect_one_line(dynslam("sim --world nowhere --speed 0"), 2, "nowhere");
  expect_one_line(dynslam("sim --mission fly --speed 0"), 2, "fly");
  expect_one_line(dynslam("sim --speed -1"), 2, "--speed");
  expect_one_line(dynslam("sim --speed 0 --laps 0"), 2, "--laps");
  expect_one_line(dynslam("sim --speed 0 --fault lidar:broken:1"), 2, "lidar:broken:1");
  expect_one_line(dynslam("sim --speed 0 --kick 1"), 2, "AT:FORWARD:LEFT");
  const std::string world = file("bad.toml", "name = \"bad\"\nstart = { at = [1, 1] }\nwals = []\n");
  const Outcome o = dynslam("sim --speed 0 --world " + world);
  EXPECT_EQ(o.code, 2);
  EXPECT_THAT(o.err, HasSubstr("bad.toml:3"));
}

TEST_F(CommandLine, ChecksAConfigFile) {
  const Outcome good = dynslam("check-config " + file("good.toml", "[slam]\ncell_size_m = 0.05\n"));
  EXPECT_EQ(good.code, 0) << good.err;
  EXPECT_THAT(good.out, HasSubstr("cell_size_m = 0.05"));
  const Outcome bad = dynslam("check-config " + file("bad.toml", "[slam]\ncell_size = 0.05\n"));
  EXPECT_EQ(bad.code, 2);
  EXPECT_THAT(bad.err, HasSubstr("bad.toml:2"));
}

TEST_F(CommandLine, TakesSettingsFromFileAndLine) {
  const std::string log = file("short.log", short_log(60));
  const std::string config = file("robot.toml", "[slam]\ncell_size_m = 0.05\n");
  const std::string out = (folder_ / "out").string();
  EXPECT_EQ(
      dynslam("replay " + log + " --config " + config + " --set slam.trusted_range_m=6 --quiet --out " + out)
          .code,
      0);
  EXPECT_THAT(contents(folder_ / "out/map.yaml"), HasSubstr("resolution: 0.05"));
}

TEST_F(CommandLine, MeasuresWhatTheWorkCosts) {
  const Outcome o = dynslam("bench --duration 3 --seed 2");
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_EQ(o.err, "");
  EXPECT_THAT(o.out, HasSubstr("mapping, a scan"));
  const auto begin = o.out.find("dynslam-bench: ");
  ASSERT_NE(begin, std::string::npos);
  const std::string line = o.out.substr(begin);
  EXPECT_EQ(line.find('\n'), line.size() - 1) << "the last line is the one to send";
  EXPECT_THAT(line, HasSubstr(" world=\"apartment\" seed=2 drive_s=3 scans=2"));
  for (const char* nothing : {"map_ms=0.000/", "plan_ms=0.000/", "client_ms=0.000/", "jpeg_ms=0.000/",
                              "core_pct=0.0 ", "rss_mib=0"})
    EXPECT_THAT(line, Not(HasSubstr(nothing)));
}

TEST_F(CommandLine, NamesWhatCannotBeMeasured) {
  expect_one_line(dynslam("bench --world /no/such/world.toml"), 2, "/no/such/world.toml");
  expect_one_line(dynslam("bench --duration 0"), 2, "--duration");
  expect_one_line(dynslam("bench --set slam.cell_size_m=-1"), 2, "cell_size_m");
}

TEST(ProgressLine, ShowsShareRateAndTimeLeft) {
  const std::string line = progress_line(0.5, 1000, 2.0);
  EXPECT_THAT(line, HasSubstr("###"));
  EXPECT_THAT(line, HasSubstr("50 %"));
  EXPECT_THAT(line, HasSubstr("500/s"));
  EXPECT_THAT(line, HasSubstr("2 s left"));
  EXPECT_THAT(progress_line(0, 0, 0.1), HasSubstr("0 %"));
  EXPECT_THAT(progress_line(7, 1, 0.1), HasSubstr("100 %"));
}

}  // namespace
}  // namespace dynslam
