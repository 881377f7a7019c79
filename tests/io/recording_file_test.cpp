// SPDX-License-Identifier: MIT
#include "io/recording_file.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <unistd.h>

#include "io/mcap_file.h"
#include "io/recording_folder.h"
#include "tests/io/file_size_limit.h"
#include "tests/io/read_all.h"

namespace dynslam {
namespace {

namespace fs = std::filesystem;
using test::Contents;
using test::read_all;
using testing::ElementsAre;
using testing::HasSubstr;

std::string contents(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A folder of its own for each test, gone afterwards.
class RecordingFiles : public ::testing::Test {
 protected:
  RecordingFiles() {
    std::string pattern = fs::temp_directory_path() / "dynslam-test-XXXXXX";
    folder_ = mkdtemp(pattern.data());
  }
  ~RecordingFiles() override { fs::remove_all(folder_); }

  std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const auto& entry : fs::directory_iterator(folder_)) found.push_back(entry.path().filename());
    std::sort(found.begin(), found.end());
    return found;
  }
  void put(const std::string& name, std::size_t size) const {
    std::ofstream(folder_ / name) << std::string(size, 'x');
  }

  fs::path folder_;
};

/// Scans with ranges that do not pack, a chunk each, until there is no more room. How many there were.
int fill(McapFile& file, std::string& trouble) {
  unsigned noise = 1;
  for (int i = 0; i < 1000; ++i) {
    Scan scan{Time(std::chrono::milliseconds(100 * (i + 1))), {}, {}};
    for (int b = 0; b < 1000; ++b) {
      noise = noise * 1664525U + 1013904223U;
      scan.beams.push_back(
          {0.001F * static_cast<float>(b), 1.0F + static_cast<float>(noise >> 8) * 1e-6F, 0.0F});
    }
    file.ros().write(scan.stamp, scan);
    try {
      file.close_chunk();
    } catch (const std::runtime_error& e) {
      trouble = e.what();
      return i;
    }
  }
  return 1000;
}

TEST_F(RecordingFiles, GrowsAndMakesItsFolder) {
  RecordingFile file(folder_ / "a/b/file", 0);
  file.append("one ");
  file.sync_soon();
  file.append("two");
  EXPECT_EQ(file.size(), 7U);
  file.sync();
  EXPECT_FALSE(file.syncing());
  EXPECT_EQ(contents(folder_ / "a/b/file"), "one two");
}

TEST_F(RecordingFiles, NeverTouchesWhatIsThere) {
  put("file", 3);
  EXPECT_THROW(RecordingFile(folder_ / "file", 0), std::runtime_error);
  EXPECT_EQ(contents(folder_ / "file"), "xxx");
  put("no folder", 1);
  try {
    RecordingFile(folder_ / "no folder/file", 0);
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_THAT(e.what(), HasSubstr("no folder"));
  }
}

TEST_F(RecordingFiles, KeepsAFloorOfTheDiskFree) {
  RecordingFile file(folder_ / "file", std::uint64_t{1} << 60);
  try {
    file.append("x");
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_THAT(e.what(), HasSubstr("are to stay free"));
  }
  EXPECT_EQ(contents(folder_ / "file"), "");
  file.use_floor();
  file.append("x");
  EXPECT_EQ(file.size(), 1U);
}

TEST_F(RecordingFiles, AFullDiskLeavesWholeChunksWhereverItEnds) {
  for (rlim_t limit = 300; limit < 40'000; limit += 1777) {
    SCOPED_TRACE(limit);
    const fs::path path = folder_ / std::to_string(limit);
    std::string trouble;
    int scans = -1;
    {
      const test::FileSizeLimit only(limit);
      try {
        McapFile file(path, 0, "test", {});
        scans = fill(file, trouble);
        EXPECT_THAT(trouble, HasSubstr(path.string()));
        EXPECT_FALSE(file.finish().empty()) << "there is no room for what waits";
        EXPECT_LE(file.file().size(), limit);
        EXPECT_EQ(file.file().size(), fs::file_size(path));
      } catch (const std::runtime_error&) {
        EXPECT_FALSE(fs::exists(path)) << "there was no room for the head";
        continue;
      }
    }
    const Contents all = read_all(contents(path));
    EXPECT_EQ(all.scans.size(), static_cast<std::size_t>(scans));
  }
}

TEST_F(RecordingFiles, AFullDiskEndsWithAnIndexWhenThereIsAFloor) {
  if (getuid() != 0 || ::mount("tmpfs", folder_.c_str(), "tmpfs", 0, "size=3m") != 0)
    GTEST_SKIP() << "a disk that is small takes root to make";
  std::string trouble;
  int scans = 0;
  {
    McapFile file(folder_ / "full.mcap", 1 << 20, "test", {});
    scans = fill(file, trouble);
    EXPECT_EQ(file.finish(), "") << "the floor is for this";
  }
  const Contents floor = read_all(contents(folder_ / "full.mcap"));
  {
    McapFile file(folder_ / "to the brim.mcap", 0, "test", {});
    fill(file, trouble);
    file.finish();
  }
  const Contents brim = read_all(contents(folder_ / "to the brim.mcap"));
  ::umount(folder_.c_str());
  EXPECT_GT(scans, 200);
  EXPECT_LT(scans, 800);
  EXPECT_EQ(floor.scans.size(), static_cast<std::size_t>(scans) + 1) << "with what waited";
  EXPECT_EQ(floor.damage, std::nullopt);
  EXPECT_GT(brim.scans.size(), 100U);
  EXPECT_THAT(trouble, HasSubstr("No space left"));
}

TEST_F(RecordingFiles, TheRingLosesItsOldestAndNothingElse) {
  for (int i = 8; i < 12; ++i)
    put(i < 10 ? "ring-0000000" + std::to_string(i) + ".mcap" : "ring-000000" + std::to_string(i) + ".mcap",
        1000);
  for (const char* name : {"recording-1.mcap", "ring-1.mcap", "ring-00000001.txt", "ring-x0000001.mcap"})
    put(name, 1000);
  const RecordingFolder folder(folder_);
  EXPECT_EQ(folder.next_in_ring(), (folder_ / "ring-00000012.mcap").string());
  folder.shrink_ring(4000, 0);
  EXPECT_EQ(names().size(), 8U);
  folder.shrink_ring(2999, 0);
  EXPECT_THAT(names(), ElementsAre("recording-1.mcap", "ring-00000001.txt", "ring-00000010.mcap",
                                   "ring-00000011.mcap", "ring-1.mcap", "ring-x0000001.mcap"));
  folder.shrink_ring(2999, std::uint64_t{1} << 60);
  EXPECT_EQ(names().size(), 6U) << "nothing goes for room that cannot be had";
  folder.shrink_ring(0, 0);
  EXPECT_THAT(names(),
              ElementsAre("recording-1.mcap", "ring-00000001.txt", "ring-1.mcap", "ring-x0000001.mcap"));
  EXPECT_EQ(folder.next_in_ring(), (folder_ / "ring-00000001.mcap").string());
}

TEST_F(RecordingFiles, TheRingMakesRoomOnADiskThatOthersFill) {
  if (getuid() != 0 || ::mount("tmpfs", folder_.c_str(), "tmpfs", 0, "size=4m") != 0)
    GTEST_SKIP() << "a disk that is small takes root to make";
  for (const char* name : {"ring-00000001.mcap", "ring-00000002.mcap", "other"}) put(name, 1 << 20);
  const RecordingFolder folder(folder_);
  folder.shrink_ring(1 << 30, 3 << 19);
  const auto left = names();
  ::umount(folder_.c_str());
  EXPECT_THAT(left, ElementsAre("other", "ring-00000002.mcap"));
}

TEST_F(RecordingFiles, NewNamesAreNew) {
  const RecordingFolder folder(folder_);
  EXPECT_EQ(folder.new_file("a"), (folder_ / "recording-a.mcap").string());
  put("recording-a.mcap", 1);
  put("recording-a-2.mcap", 1);
  EXPECT_EQ(folder.new_file("a"), (folder_ / "recording-a-3.mcap").string());
  EXPECT_EQ(RecordingFolder(folder_ / "missing").next_in_ring(),
            (folder_ / "missing/ring-00000001.mcap").string());
  EXPECT_THROW(RecordingFolder(folder_ / "recording-a.mcap").next_in_ring(), std::runtime_error);
}

}  // namespace
}  // namespace dynslam
