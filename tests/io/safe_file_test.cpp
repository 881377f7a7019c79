// SPDX-License-Identifier: MIT
#include "io/safe_file.h"

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "base/error.h"
#include "tests/io/file_size_limit.h"

namespace dynslam {
namespace {

namespace fs = std::filesystem;

using test::FileSizeLimit;

class OutputFolderTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "dynslam-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    root_ = name;
  }
  void TearDown() override { fs::remove_all(root_); }

  std::string path(const std::string& name) const { return (root_ / name).string(); }
  std::string read(const std::string& name) const {
    std::ifstream file(root_ / name, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }
  void write(const std::string& name, const std::string& text) const { std::ofstream(root_ / name) << text; }
  std::set<std::string> names() const {
    std::set<std::string> all;
    for (const auto& entry : fs::directory_iterator(root_)) all.insert(entry.path().filename());
    return all;
  }
  static std::string message_of(const std::string& folder) {
    try {
      OutputFolder out(folder);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  fs::path root_;
};

TEST_F(OutputFolderTest, CreatesTheFolderWithItsParents) {
  const OutputFolder out(path("a/b/c"));
  EXPECT_TRUE(fs::is_directory(root_ / "a/b/c"));
  EXPECT_TRUE(fs::is_empty(root_ / "a/b/c")) << "the try-out is gone";
  EXPECT_EQ(out.path(), path("a/b/c"));
}

TEST_F(OutputFolderTest, ShowsFilesOnlyAfterCommit) {
  OutputFolder out(root_);
  out.stage("map.pgm", "pixels");
  out.stage("empty", "");
  EXPECT_EQ(names().count("map.pgm"), 0U);
  out.commit();
  EXPECT_EQ(names(), (std::set<std::string>{"map.pgm", "empty"}));
  EXPECT_EQ(read("map.pgm"), "pixels");
  EXPECT_EQ(read("empty"), "");
}

TEST_F(OutputFolderTest, KeepsTheOlderResultWithoutCommit) {
  write("map.pgm", "old");
  {
    OutputFolder out(root_);
    out.stage("map.pgm", "new");
    out.stage("map.yaml", "new");
    EXPECT_EQ(read("map.pgm"), "old");
  }
  EXPECT_EQ(read("map.pgm"), "old");
  EXPECT_EQ(names(), (std::set<std::string>{"map.pgm"}));
}

TEST_F(OutputFolderTest, ReplacesTheOlderResult) {
  write("map.pgm", "an older and longer result");
  write(".map.pgm.partial", "what a killed run left behind");
  OutputFolder out(root_);
  out.stage("map.pgm", "first");
  out.stage("map.pgm", "new");
  out.commit();
  out.commit();
  EXPECT_EQ(read("map.pgm"), "new");
  EXPECT_EQ(names(), (std::set<std::string>{"map.pgm"}));
}

TEST_F(OutputFolderTest, WritesPieceByPiece) {
  OutputFolder out(root_);
  out.stage("big", [](const ByteSink& sink) {
    for (int i = 0; i < 3; ++i) sink("ab");
  });
  out.commit();
  EXPECT_EQ(read("big"), "ababab");
}

TEST_F(OutputFolderTest, LeavesNothingWhenTheDiskIsFull) {
  write("map.pgm", "old");
  {
    OutputFolder out(root_);
    out.stage("map.yaml", "small");
    const FileSizeLimit limit(1000);
    try {
      out.stage("map.pgm", std::string(5000, 'x'));
      ADD_FAILURE() << "must throw";
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(std::string(error.what()), "cannot write to " + path("map.pgm") + ": File too large");
    }
    EXPECT_EQ(names(), (std::set<std::string>{"map.pgm", ".map.yaml.partial"}));
  }
  EXPECT_EQ(names(), (std::set<std::string>{"map.pgm"}));
  EXPECT_EQ(read("map.pgm"), "old");
}

TEST_F(OutputFolderTest, LeavesNothingWhenTheWriterFails) {
  OutputFolder out(root_);
  const auto fail = [](const ByteSink& sink) {
    sink("half");
    throw std::logic_error("no more");
  };
  EXPECT_THROW(out.stage("map.png", fail), std::logic_error);
  EXPECT_TRUE(names().empty());
}

TEST_F(OutputFolderTest, SaysAtTheStartThatItCannotWrite) {
  write("file", "");
  EXPECT_EQ(message_of(path("file")), "cannot write to " + path("file") + ": Not a directory");
  EXPECT_EQ(message_of(path("file/below")), "cannot write to " + path("file/below") + ": Not a directory");
  EXPECT_EQ(message_of("/proc/nowhere"), "cannot write to /proc/nowhere: No such file or directory");
  EXPECT_EQ(message_of("/dev/full"), "cannot write to /dev/full: Not a directory");
  EXPECT_NE(message_of("/proc"), "no error") << "is a folder, but takes no files";
  EXPECT_NE(message_of(""), "no error");
}

TEST_F(OutputFolderTest, SaysAtTheStartThatTheDiskIsFull) {
  const FileSizeLimit limit(0);
  EXPECT_EQ(message_of(root_), "cannot write to " + root_.string() + ": File too large");
  EXPECT_TRUE(names().empty());
}

TEST_F(OutputFolderTest, RefusesAFileWhereAFolderIs) {
  fs::create_directory(root_ / "map.pgm");
  OutputFolder out(root_);
  EXPECT_THROW(out.stage("map.pgm", "new"), std::runtime_error);
  EXPECT_EQ(names(), (std::set<std::string>{"map.pgm"}));
}

TEST_F(OutputFolderTest, FailsToCommitWhatWasTakenAway) {
  OutputFolder out(root_);
  out.stage("map.pgm", "new");
  fs::remove(root_ / ".map.pgm.partial");
  EXPECT_THROW(out.commit(), std::runtime_error);
}

TEST_F(OutputFolderTest, NamesAFileThatIsWrittenElsewhere) {
  write("a", "older");
  write("b", "older");
  write(".a.partial", "left behind by a killed run");
  OutputFolder out(root_.string());
  const std::string a = out.reserve("a");
  out.reserve("b");
  EXPECT_FALSE(fs::exists(a));
  std::ofstream(a) << "newer";
  EXPECT_EQ(read("a"), "older");
  out.commit();
  EXPECT_EQ(names(), std::set<std::string>{"a"}) << "an older b would be of another run";
  EXPECT_EQ(read("a"), "newer");
}

TEST_F(OutputFolderTest, DiscardsWhatIsWrittenElsewhereWithoutCommit) {
  {
    OutputFolder out(root_.string());
    std::ofstream(out.reserve("a")) << "never to be seen";
    fs::create_directory(root_ / "taken");
    EXPECT_THROW(out.reserve("taken"), std::runtime_error);
  }
  EXPECT_EQ(names(), std::set<std::string>{"taken"});
}

TEST_F(OutputFolderTest, BelongsToOneRunAtATime) {
  {
    const OutputFolder out(root_);
    EXPECT_EQ(message_of(root_), "cannot write to " + root_.string() + ": another run is writing there");
  }
  EXPECT_EQ(message_of(root_), "no error");
}

}  // namespace
}  // namespace dynslam
