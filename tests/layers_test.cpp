// SPDX-License-Identifier: MIT
// Holds the drawing of the layers: who may include whom. A folder may include itself and the folders of its
// row.
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace {

namespace fs = std::filesystem;
using Folders = std::set<std::string>;

const Folders kLayer0 = {"base"};
const Folders kLayer1 = {"base", "grid", "pipe"};
const Folders kLayer2 = {"base", "grid", "pipe", "plan", "drive", "device"};

/// What each folder may include besides itself; a folder that is not named may include nothing.
const std::map<std::string, Folders> kMayInclude = {
    {"base", {}},
    {"grid", kLayer0},
    {"pipe", kLayer0},
    {"plan", kLayer1},
    {"drive", kLayer1},
    {"device", kLayer1},
    {"slam", kLayer2},
    {"autopilot", kLayer2},
    {"io", kLayer2},
    {"sim", kLayer2},
    {"drivers", kLayer2},
    {"robot", {"base", "grid", "pipe", "plan", "drive", "device", "slam", "autopilot", "io"}},
    {"server", {"base", "grid", "pipe", "plan", "drive", "device", "slam", "autopilot", "io", "robot"}},
};

/// Libraries that only one folder may see, by the first part of what is included.
const std::map<std::string, std::string> kOnlyIn = {
    {"ceres", "slam"},  {"civetweb.h", "server"}, {"gpiod.h", "drivers"},   {"libcamera", "drivers"},
    {"i2c", "drivers"}, {"sodium.h", "server"},   {"qrencode.h", "server"},
};

struct Include {
  std::string file, folder, target;
};

std::vector<Include> all_includes() {
  std::vector<Include> found;
  const std::regex line_form(R"(^\s*#\s*include\s*["<]([^">]+)[">])");
  const fs::path root = DYNSLAM_SOURCE_DIR;
  for (const char* top : {"src", "drivers"}) {
    if (!fs::exists(root / top)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const std::string extension = entry.path().extension();
      if (extension != ".h" && extension != ".cpp") continue;
      const fs::path inside = fs::relative(entry.path(), root / top);
      const std::string first = *inside.begin();
      const std::string folder = std::string(top) == "drivers" ? "drivers"
                                 : inside.has_parent_path()    ? first
                                                               : "";
      std::ifstream in(entry.path());
      for (std::string line; std::getline(in, line);) {
        std::smatch m;
        if (std::regex_search(line, m, line_form)) found.push_back({entry.path(), folder, m[1]});
      }
    }
  }
  return found;
}

std::string first_part(const std::string& target) { return target.substr(0, target.find('/')); }

TEST(Layers, NoFolderIncludesAnythingAboveIt) {
  const auto includes = all_includes();
  ASSERT_GT(includes.size(), 50U) << "the search for includes found next to nothing: is it broken?";
  for (const Include& i : includes) {
    const std::string target = first_part(i.target);
    if (i.folder.empty() || target == i.folder || !kMayInclude.contains(target))
      continue;  // main and config see all
    const auto row = kMayInclude.find(i.folder);
    ASSERT_NE(row, kMayInclude.end()) << i.file << ": folder '" << i.folder << "' has no row in the table";
    EXPECT_TRUE(row->second.contains(target)) << i.file << " includes " << i.target;
  }
}

TEST(Layers, TheServerKnowsNothingOfTheRobotButItsPorts) {
  for (const Include& i : all_includes()) {
    EXPECT_TRUE(i.folder != "server" || first_part(i.target) != "robot" || i.target == "robot/ports.h")
        << i.file;
  }
}

TEST(Layers, TopFilesAreIncludedByNobodyBelow) {
  for (const Include& i : all_includes()) {
    EXPECT_TRUE(i.folder.empty() || i.target != "config.h") << i.file;
  }
}

TEST(Layers, LibrariesStayWhereTheyBelong) {
  for (const Include& i : all_includes()) {
    const auto only = kOnlyIn.find(first_part(i.target));
    EXPECT_TRUE(only == kOnlyIn.end() || i.folder == only->second) << i.file << " includes " << i.target;
  }
}

}  // namespace
