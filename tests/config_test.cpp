// SPDX-License-Identifier: MIT
#include "config.h"

#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "base/nearest_name.h"
#include "config_keys.h"

namespace dynslam {
namespace {

using Lines = std::vector<std::string>;

/// One key of each type.
struct Sample {
  bool flag = false;
  int count = 3;
  double size_m = 0.5;
  double least = 1.0;
  double most = 1.0;
  double any = 0.0;
  std::string port = "/dev/ttyUSB0";

  std::vector<ConfigKey> keys() {
    return {{"one", {"flag", "whether"}, &flag},
            {"one", {"count", "how many", 1, 10}, &count},
            {"one", {"size_m", "how large", 0.1, 2.0}, &size_m},
            {"two", {"least", "at least", 1.0}, &least},
            {"two", {"most", "at most", -HUGE_VAL, 9.0}, &most},
            {"two", {"any", "anything"}, &any},
            {"two", {"port", "where"}, &port}};
  }
  Lines read(std::string_view text) { return read_toml(text, "f.toml", keys()).problems; }
  Lines set(std::string_view setting) { return read_setting(setting, keys()); }
};

TEST(ReadToml, SetsEveryType) {
  Sample s;
  EXPECT_EQ(s.read("[one]\nflag = true\ncount = 7\nsize_m = 1.25\n[two]\nport = 'x'\nany = -1e9"), Lines{});
  EXPECT_TRUE(s.flag);
  EXPECT_EQ(s.count, 7);
  EXPECT_EQ(s.size_m, 1.25);
  EXPECT_EQ(s.any, -1e9);
  EXPECT_EQ(s.port, "x");
}

TEST(ReadToml, LeavesOutWhatIsNotThere) {
  Sample s;
  EXPECT_EQ(s.read("# nothing\r\n[one]\r\n"), Lines{});
  EXPECT_EQ(s.count, 3);
}

TEST(ReadToml, TakesAWholeNumberForANumber) {
  Sample s;
  EXPECT_EQ(s.read("one.size_m = 2"), Lines{});
  EXPECT_EQ(s.size_m, 2.0);
}

TEST(ReadToml, KeepsLimitsInclusive) {
  Sample s;
  EXPECT_EQ(s.read("[one]\ncount = 10\nsize_m = 0.1"), Lines{});
  EXPECT_EQ(s.read("one.count = 11"),
            (Lines{"f.toml:1: one.count: must be a whole number from 1 to 10, not 11"}));
  EXPECT_EQ(s.count, 10);
}

TEST(ReadToml, ReportsEverythingAtOnceByLine) {
  Sample s;
  EXPECT_EQ(s.read("[two]\n"
                   "port = 5\n"
                   "most = 9.5\n"
                   "least = 0\n"
                   "any = nan\n"
                   "[one]\n"
                   "size_m = inf\n"
                   "flag = 1\n"
                   "cuont = 4\n"
                   "count = 4.0\n"),
            (Lines{"f.toml:2: two.port: must be a text in quotes, not 5",
                   "f.toml:3: two.most: must be a number of at most 9, not 9.5",
                   "f.toml:4: two.least: must be a number of at least 1, not 0",
                   "f.toml:5: two.any: must be a number, not nan",
                   "f.toml:7: one.size_m: must be a number from 0.1 to 2, not inf",
                   "f.toml:8: one.flag: must be true or false, not 1",
                   "f.toml:9: one.cuont: unknown key; the nearest known key is one.count",
                   "f.toml:10: one.count: must be a whole number from 1 to 10, not 4.0"}));
  EXPECT_EQ(s.count, 3);
}

TEST(ReadToml, ShowsWhatWasWrittenInOneLine) {
  Sample s;
  EXPECT_EQ(s.read("[one]\nflag = [1]\ncount = {a = 1}\nsize_m = \"a\\n\\\"b\\\"\""),
            (Lines{"f.toml:2: one.flag: must be true or false, not an array",
                   "f.toml:3: one.count: must be a whole number from 1 to 10, not a table",
                   "f.toml:4: one.size_m: must be a number from 0.1 to 2, not \"a\\u000a\\\"b\\\"\""}));
  EXPECT_EQ(s.read("one.flag = 2020-01-01"),
            (Lines{"f.toml:1: one.flag: must be true or false, not 2020-01-01"}));
}

TEST(ReadToml, RefusesNumbersThatDoNotFit) {
  int count = 0;
  const std::vector<ConfigKey> keys = {{"a", {"n", "no limits"}, &count}};
  EXPECT_EQ(read_toml("a.n = 3000000000", "f", keys).problems,
            (Lines{"f:1: a.n: must be a whole number, not 3000000000"}));
  EXPECT_EQ(read_toml("a.n = -9223372036854775808", "f", keys).problems.size(), 1U);
  EXPECT_EQ(read_toml("a.n = 2147483647", "f", keys).problems, Lines{});
  EXPECT_EQ(count, 2147483647);
}

TEST(ReadToml, SetsAListOfTexts) {
  Lines hosts = {"old"};
  const std::vector<ConfigKey> keys = {{"a", {"hosts", "who"}, &hosts}};
  const Lines problem = {"f:1: a.hosts: must be a list of texts in quotes, not "};
  EXPECT_EQ(read_toml("a.hosts = 'x'", "f", keys).problems, (Lines{problem[0] + "\"x\""}));
  EXPECT_EQ(read_toml("a.hosts = ['x', 2]", "f", keys).problems, (Lines{problem[0] + "an array"}));
  EXPECT_EQ(hosts, (Lines{"old"})) << "nothing of a list that is wrong";
  EXPECT_EQ(read_toml("a.hosts = ['x', \"y z\",\n'\"',]", "f", keys).problems, Lines{});
  EXPECT_EQ(hosts, (Lines{"x", "y z", "\""}));
  EXPECT_EQ(to_toml(keys), "[a]\n# who: a list of texts in quotes\nhosts = [\"x\", \"y z\", \"\\\"\"]\n");
  EXPECT_EQ(to_json(keys).dump(), R"({"a":{"hosts":["x","y z","\""]}})");
  EXPECT_EQ(read_setting("a.hosts=[]", keys), Lines{});
  EXPECT_EQ(hosts, Lines{});
}

TEST(ReadToml, SuggestsNames) {
  Sample s;
  EXPECT_EQ(s.read("size_m = 1\n[oen]\nflag = true"),
            (Lines{"f.toml:1: size_m: unknown key; the nearest known key is one.size_m",
                   "f.toml:2: oen: unknown table; the nearest known table is [one]"}));
  EXPECT_EQ(s.read("two.size_m = 1"),
            (Lines{"f.toml:1: two.size_m: unknown key; the nearest known key is one.size_m"}));
}

TEST(ReadToml, WantsATableForASection) {
  Sample s;
  EXPECT_EQ(s.read("one = 4"), (Lines{"f.toml:1: one: must be a table, not 4"}));
  EXPECT_EQ(s.read("[[one]]\ncount = 4"), (Lines{"f.toml:1: one: must be a table, not an array"}));
}

TEST(ReadToml, SaysWhereTheTextIsNotToml) {
  Sample s;
  const Lines problems = s.read("[one]\ncount = = 4");
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_TRUE(problems[0].starts_with("f.toml:2:9: ")) << problems[0];
  EXPECT_EQ(problems[0].find('\n'), std::string::npos);
  for (const char* bad : {"\xff\xfe", "[one", "one.count = 1\none.count = 2", "[one]\n[one]", "a = \"open"}) {
    EXPECT_EQ(s.read(bad).size(), 1U) << bad;
  }
  EXPECT_EQ(s.read(std::string("one.count = 1\0", 14)).size(), 1U);
  EXPECT_EQ(s.read("a = " + std::string(100000, '[')).size(), 1U);
}

TEST(ReadSetting, SetsEveryType) {
  Sample s;
  for (const char* one : {"one.flag=true", "one.count=7", "one.size_m=1.25", "two.any=-1"}) {
    EXPECT_EQ(s.set(one), Lines{}) << one;
  }
  EXPECT_TRUE(s.flag && s.count == 7 && s.size_m == 1.25 && s.any == -1.0);
}

TEST(ReadSetting, TakesATextWithAndWithoutQuotes) {
  Sample s;
  for (const char* text : {"two.port=/dev/a=b", "two.port='/dev/a=b'", "two.port=\"/dev/a=b\""}) {
    s.port = "";
    EXPECT_EQ(s.set(text), Lines{});
    EXPECT_EQ(s.port, "/dev/a=b");
  }
  EXPECT_EQ(s.set("two.port='open"), (Lines{"--set two.port='open: must be a text in quotes"}));
}

TEST(ReadSetting, SaysWhatIsWrong) {
  Sample s;
  EXPECT_EQ(s.set("one.count"), (Lines{"--set one.count: must be section.key=value"}));
  EXPECT_EQ(s.set("count=4"), (Lines{"--set count=4: unknown key; the nearest known key is one.count"}));
  for (const char* value : {"", "abc", "4.5", "0", "4\nother = 5", "true", "[4]"}) {
    const std::string setting = std::string("one.count=") + value;
    EXPECT_EQ(s.set(setting), (Lines{"--set " + setting + ": must be a whole number from 1 to 10"}));
  }
  EXPECT_EQ(s.count, 3);
}

TEST(ToToml, IsCommentedAndReadsBack) {
  Sample s;
  s.port = "a\"b\\c\x01\x7f \xc3\xa4";
  s.size_m = 1.0 / 3.0;
  s.any = 1e-300;
  s.most = -1e22;
  const std::string text = to_toml(s.keys());
  EXPECT_TRUE(
      text.starts_with("[one]\n"
                       "# whether: true or false\n"
                       "flag = false\n"
                       "# how many: a whole number from 1 to 10\n"
                       "count = 3\n"))
      << text;
  EXPECT_NE(text.find("\n\n[two]\n# at least: a number of at least 1\nleast = 1.0\n"), std::string::npos)
      << text;
  Sample back;
  EXPECT_EQ(back.read(text), Lines{});
  EXPECT_EQ(back.port, s.port);
  EXPECT_EQ(back.size_m, s.size_m);
  EXPECT_EQ(back.any, s.any);
  EXPECT_EQ(back.most, s.most);
}

TEST(ToJson, HoldsEveryKey) {
  Sample s;
  EXPECT_EQ(to_json(s.keys()).dump(), R"({"one":{"count":3,"flag":false,"size_m":0.5},)"
                                      R"("two":{"any":0.0,"least":1.0,"most":1.0,"port":"/dev/ttyUSB0"}})");
}

TEST(NearestName, CountsLetters) {
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
  EXPECT_EQ(nearest_name("colour", {"odour", "color", "collar"}), "color");
  EXPECT_EQ(nearest_name("x", {}), "");
}

class ConfigFileTest : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }
  std::string write(const std::string& text) const {
    std::ofstream(path_, std::ios::binary) << text;
    return path_;
  }
  static Lines problems_of(const std::optional<std::string>& path, const Lines& settings) {
    try {
      make_config(path, settings);
    } catch (const ConfigError& error) {
      return error.problems;
    }
    return {};
  }
  static std::string message_of(const std::string& path) {
    try {
      load_config(path);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  std::string path_ =
      (std::filesystem::temp_directory_path() / ("dynslam-config-" + std::to_string(getpid()) + ".toml"))
          .string();
};

TEST_F(ConfigFileTest, ReadsAFile) {
  const Config config =
      load_config(write("slam.cell_size_m = 0.05\n[lidar]\nyaw_rad = 3.5\nupside_down = true\n"));
  EXPECT_EQ(config.slam.cell_size_m, 0.05);
  EXPECT_EQ(config.slam.trusted_range_m, SlamConfig{}.trusted_range_m);
  EXPECT_TRUE(config.lidar.mount().upside_down);
  EXPECT_NEAR(config.lidar.mount().robot_T_lidar.yaw, 3.5 - kTwoPi, 1e-12);
}

TEST_F(ConfigFileTest, LetsSettingsOverruleTheFile) {
  const Config config =
      make_config(write("slam.cell_size_m = 0.05"), {"slam.cell_size_m=0.1", "lidar.x_m=0.2"});
  EXPECT_EQ(config.slam.cell_size_m, 0.1);
  EXPECT_EQ(config.lidar.mount().robot_T_lidar.x, 0.2);
}

TEST_F(ConfigFileTest, ReportsTheProblemsOfFileAndSettingsTogether) {
  write("[slam]\ncell_size_m = 0.9\n");
  const Lines expected = {path_ + ":2: slam.cell_size_m: must be a number from 0.005 to 0.5, not 0.9",
                          "--set slam.cell_sise_m=1: unknown key; the nearest known key is slam.cell_size_m"};
  EXPECT_EQ(problems_of(path_, {"slam.cell_sise_m=1"}), expected);
  EXPECT_EQ(std::string(ConfigError(expected).what()), expected[0] + "\n" + expected[1]);
}

TEST_F(ConfigFileTest, ReportsWhatNoLimitSays) {
  EXPECT_EQ(problems_of(std::nullopt, {"access.allowed_hosts=['http://a']"}),
            (Lines{"access.allowed_hosts: \"http://a\" is no name of a machine, as \"robot.lan\""}));
  EXPECT_EQ(problems_of(std::nullopt, {"access.client_networks=['10.0.0.0/33']"}),
            (Lines{"access.client_networks: \"10.0.0.0/33\" is no network, as \"100.64.0.0/10\""}));
}

TEST_F(ConfigFileTest, TakesAnyNameForTheRobotThatCanBeShown) {
  EXPECT_EQ(make_config(std::nullopt, {"server.name=R\xc3\xb6\xc3\xb6t"}).server.name, "R\xc3\xb6\xc3\xb6t");
  EXPECT_EQ(problems_of(std::nullopt, {"server.name=" + std::string(41, 'x')}),
            (Lines{"server.name: must be 1 to 40 characters, none of them a control character"}));
}

TEST_F(ConfigFileTest, TakesALineOfTheHeaderForOneThingOnly) {
  std::vector<std::string> settings = {"encoders.left_a_line=5", "encoders.left_b_line=6",
                                       "encoders.right_a_line=13", "encoders.right_b_line=17"};
  EXPECT_EQ(problems_of(std::nullopt, settings), Lines{});
  settings.push_back("gpio.estop_line=17");
  EXPECT_EQ(problems_of(std::nullopt, settings), Lines{"encoders: line 17 is one of gpio's too"});
  settings.push_back("gpio.pull=sideways");
  EXPECT_EQ(problems_of(std::nullopt, settings),
            (Lines{"gpio.pull: not 'up', 'down' or 'none'", "encoders: line 17 is one of gpio's too"}));
}

TEST_F(ConfigFileTest, SaysWhyAFileCannotBeRead) {
  EXPECT_EQ(message_of("/nowhere/x.toml"), "cannot read config /nowhere/x.toml: No such file or directory");
  EXPECT_EQ(message_of("/tmp"), "cannot read config /tmp: is a directory");
  EXPECT_EQ(message_of("/proc/self/mem"), "cannot read config /proc/self/mem: Input/output error");
  EXPECT_EQ(message_of("/dev/zero"), "cannot read config /dev/zero: is no regular file");
  EXPECT_EQ(message_of(write("")), "no error");
}

TEST(ApplySetting, ChangesOneKeyOrNothing) {
  Config config;
  apply_setting(config, "slam.scans_per_local_map=80");
  EXPECT_EQ(config.slam.scans_per_local_map, 80);
  EXPECT_THROW(apply_setting(config, "slam.scans_per_local_map=1"), InputError);
  EXPECT_EQ(config.slam.scans_per_local_map, 80);
}

TEST_F(ConfigFileTest, ReadsBackItsReference) {
  Config config;
  config.lidar.x_m = -0.125;
  config.slam.cell_size_m = 0.05;
  config.access.allowed_hosts = {"robot.lan", "robot.example.org"};
  const std::string reference = config_reference(config);
  EXPECT_EQ(config_reference(load_config(write(reference))), reference);
  EXPECT_EQ(config_json(load_config(path_)), config_json(config));
  EXPECT_EQ(config_json(config)["slam"]["cell_size_m"], 0.05);
}

TEST_F(ConfigFileTest, HasDefaultsWithinItsLimits) {
  EXPECT_EQ(message_of(write(config_reference(Config{}))), "no error");
}

/// A file that was written for an older version.
TEST(ReadToml, ReadsAKeyByItsOldNameAndSaysSo) {
  Sample s;
  const std::vector<OldKey> old = {{"one.number", "one.count", ""},
                                   {"gone.port", "two.port", ""},
                                   {"one.speed", "", "it finds it by itself"}};
  const auto read = [&](std::string_view text) { return read_toml(text, "f", s.keys(), old); };
  const TomlFindings found = read("[one]\nnumber = 7\nspeed = 'any'\n[gone]\nport = 'x'");
  EXPECT_EQ(found.problems, Lines{});
  EXPECT_EQ(found.warnings, (Lines{"f:2: one.number: is called one.count now, and was read as that",
                                   "f:3: one.speed: is not read any more: it finds it by itself",
                                   "f:5: gone.port: is called two.port now, and was read as that"}));
  EXPECT_EQ(s.count, 7);
  EXPECT_EQ(s.port, "x");
  EXPECT_EQ(read("one.number = 8\none.count = 9").warnings,
            (Lines{"f:1: one.number: is not read, as one.count, its newer name, is there as well"}));
  EXPECT_EQ(s.count, 9);
  EXPECT_EQ(read("one.number = 11").problems.size(), 1U) << "the newer one's limits hold";
  EXPECT_EQ(read("gone.portt = 'y'").problems.size(), 1U);
}

TEST(Config, WarnsOfWhatHasChangedSinceTheFileWasWritten) {
  std::string path = (std::filesystem::temp_directory_path() / "dynslam-config-XXXXXX").string();
  close(mkstemp(path.data()));
  std::ofstream(path) << "[imu]\nbus = '/dev/i2c-4'\ncalibration_file = '/var/lib/imu'\n";
  const Config config = load_config(path);
  std::filesystem::remove(path);
  EXPECT_EQ(config.hardware.imu.bus, "/dev/i2c-4");
  EXPECT_EQ(config.warnings,
            (Lines{path + ":3: imu.calibration_file: is not read any more: the calibration is "
                          "kept in state.folder"}));
}

}  // namespace
}  // namespace dynslam
