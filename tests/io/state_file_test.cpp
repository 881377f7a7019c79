// SPDX-License-Identifier: MIT
#include "io/state_file.h"

#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "tests/io/file_size_limit.h"

namespace dynslam {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class StateFileTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "dynslam-state-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
    path_ = folder_ / "state";
  }
  void TearDown() override {
    if (mounted_) ::umount(folder_.c_str());
    fs::remove_all(folder_);
  }

  /// A small disk of its own; false where that cannot be had.
  bool mount_disk(unsigned long flags, const char* options) {
    mounted_ = getuid() == 0 && ::mount("tmpfs", folder_.c_str(), "tmpfs", flags, options) == 0;
    return mounted_;
  }
  /// What was kept, of which only "good" makes sense.
  std::string load() {
    StateFile file(folder_, "state");
    return load(file);
  }
  std::string load(StateFile& file) {
    loaded_.reset();
    return file.load([this](const std::string& text) {
      if (text != "good") throw InputError("it is not good");
      loaded_ = text;
    });
  }
  std::string text(const std::string& name) const {
    std::ostringstream out;
    out << std::ifstream(folder_ / name, std::ios::binary).rdbuf();
    return out.str();
  }
  void write(const std::string& bytes) const { std::ofstream(path_, std::ios::binary) << bytes; }

  fs::path folder_, path_;
  bool mounted_ = false;
  std::optional<std::string> loaded_;
};

TEST_F(StateFileTest, KeepsWhatWasWrittenLast) {
  EXPECT_EQ(load(), "");
  EXPECT_FALSE(loaded_) << "there is none yet";
  StateFile(folder_, "state").write("older");
  StateFile(folder_, "state").write("good");
  EXPECT_EQ(load(), "");
  EXPECT_EQ(loaded_, "good");
}

TEST_F(StateFileTest, SetsAsideWhatMakesNoSense) {
  for (const std::string& broken : {std::string(), std::string("goo"), std::string("goodgood"),
                                    std::string(512, '\0'), std::string(2 << 20, ' ')}) {
    write(broken);
    EXPECT_THAT(load(), AllOf(HasSubstr(path_.string()), HasSubstr("state.damaged"), Not(HasSubstr("\n"))));
    EXPECT_FALSE(loaded_);
    EXPECT_EQ(text("state.damaged"), broken);
    EXPECT_EQ(load(), "") << "said once";
    fs::remove(folder_ / "state.damaged");
  }
}

TEST_F(StateFileTest, LosesNoneOfMany) {
  for (const char* broken : {"1", "2", "3"}) {
    write(broken);
    load();
  }
  EXPECT_EQ(text("state.damaged") + text("state.damaged-2") + text("state.damaged-3"), "123");
}

TEST_F(StateFileTest, SetsAsideWhatIsNoFile) {
  fs::create_directory(path_);
  std::ofstream(path_ / "in it") << "x";
  EXPECT_THAT(load(), HasSubstr("it is no regular file. It is kept as state.damaged."));
  EXPECT_EQ(text("state.damaged/in it"), "x");
  fs::create_symlink(path_, path_);
  EXPECT_THAT(load(), HasSubstr("state.damaged-2"));
  ASSERT_EQ(::mkfifo(path_.c_str(), 0600), 0);
  EXPECT_THAT(load(), HasSubstr("state.damaged-3"));
  StateFile(folder_, "state").write("good");
  EXPECT_EQ(text("state"), "good");
}

TEST_F(StateFileTest, SetsAsideWhatItMayNotRead) {
  if (getuid() == 0) GTEST_SKIP() << "root may read all";
  write("good");
  fs::permissions(path_, fs::perms::none);
  EXPECT_THAT(load(), HasSubstr("Permission denied. It is kept as state.damaged."));
}

TEST_F(StateFileTest, BelongsToOneProgram) {
  const StateFile file(folder_, "state");
  EXPECT_THROW(StateFile(folder_, "state"), FolderInUse);
}

TEST_F(StateFileTest, LivesWithoutAFolderUntilThereIsOne) {
  const fs::path folder = folder_ / "stick" / "state";
  std::ofstream(folder_ / "stick") << "no folder";
  StateFile file(folder, "state");
  EXPECT_THAT(file.trouble(), HasSubstr(folder.string()));
  EXPECT_EQ(load(file), "");
  EXPECT_THROW(file.write("good"), std::runtime_error);
  fs::remove(folder_ / "stick");
  file.write("good");
  EXPECT_EQ(file.trouble(), "");
  EXPECT_EQ(text("stick/state/state"), "good");
  fs::remove_all(folder_ / "stick");
  EXPECT_THROW(file.write("good"), std::runtime_error) << "somebody took it away";
  file.write("good");
  EXPECT_EQ(text("stick/state/state"), "good");
}

TEST_F(StateFileTest, KeepsTheOlderOneWhenTheDiskIsFull) {
  StateFile file(folder_, "state");
  file.write("good");
  {
    const test::FileSizeLimit full(2);
    EXPECT_THROW(file.write("better"), std::runtime_error);
    EXPECT_THAT(file.trouble(), HasSubstr(path_.string()));
    EXPECT_EQ(text("state"), "good");
  }
  file.write("better");
  EXPECT_EQ(file.trouble(), "");
}

TEST_F(StateFileTest, StartsOnAFullDisk) {
  if (!mount_disk(0, "size=64k")) GTEST_SKIP() << "a small disk takes root";
  write("good");
  std::ofstream filler(folder_ / "filler");
  filler << std::string(1 << 20, 'x') << std::flush;
  ASSERT_TRUE(filler.bad()) << "the disk is full";
  filler.close();
  StateFile file(folder_, "state");
  EXPECT_THAT(file.trouble(), HasSubstr("No space left"));
  EXPECT_EQ(load(file), "");
  EXPECT_EQ(loaded_, "good");
  EXPECT_THROW(file.write("better"), std::runtime_error);
  EXPECT_EQ(text("state"), "good");
  fs::remove(folder_ / "filler");
  file.write("better");
  EXPECT_EQ(text("state"), "better");
}

TEST_F(StateFileTest, ReadsFromADiskThatIsReadOnlyAndNeverWritesOverWhatIsBroken) {
  if (!mount_disk(0, "size=64k")) GTEST_SKIP() << "a disk of its own takes root";
  write("good");
  ASSERT_EQ(::mount(nullptr, folder_.c_str(), nullptr, MS_REMOUNT | MS_RDONLY, nullptr), 0);
  EXPECT_EQ(load(), "");
  EXPECT_EQ(loaded_, "good");
  ASSERT_EQ(::mount(nullptr, folder_.c_str(), nullptr, MS_REMOUNT, nullptr), 0);
  write("bad");
  ASSERT_EQ(::mount(nullptr, folder_.c_str(), nullptr, MS_REMOUNT | MS_RDONLY, nullptr), 0);
  StateFile file(folder_, "state");
  EXPECT_THAT(load(file), HasSubstr("cannot be moved away either"));
  EXPECT_THAT(file.trouble(), HasSubstr("Read-only"));
  EXPECT_THROW(file.write("good"), std::runtime_error);
  ASSERT_EQ(::mount(nullptr, folder_.c_str(), nullptr, MS_REMOUNT, nullptr), 0);
  file.write("good");
  EXPECT_EQ(text("state"), "good");
  EXPECT_EQ(text("state.damaged"), "bad");
}

}  // namespace
}  // namespace dynslam
