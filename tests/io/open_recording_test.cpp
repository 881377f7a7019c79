// SPDX-License-Identifier: MIT
#include "io/open_recording.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "base/error.h"
#include "io/mcap_stream.h"
#include "tests/io/mcap_builder.h"
#include "tests/io/read_all.h"

namespace dynslam {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class OpenRecordingTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) / ("open_recording_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string file(const std::string& name, const std::string& bytes) {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return (folder_ / name).string();
  }

  static std::string error_of(const std::string& path) {
    try {
      open_recording(path);
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), StartsWith(path + ": "));
      EXPECT_THAT(error.what(), testing::Not(HasSubstr("\n")));
      return error.what();
    }
    return "";
  }

  std::filesystem::path folder_;
};

TEST_F(OpenRecordingTest, TellsTheFormatFromTheContents) {
  test::McapBuilder mcap;
  mcap.add_message(mcap.add_channel("/scan", "sensor_msgs/msg/LaserScan"), 1, test::laser_scan({}));
  const auto from_mcap = open_recording(file("a.log", mcap.finish()));
  EXPECT_EQ(test::read_all(*from_mcap).scans.size(), 1U);
  const auto from_carmen =
      open_recording(file("b.mcap", "# a log\r\n\r\nPARAM\r\nFLASER 1 2.0 0 0 0 0 0 0 1 h 1\r\n"));
  EXPECT_EQ(test::read_all(*from_carmen).scans.size(), 1U);
  EXPECT_EQ(from_carmen->progress(), 1.0);
}

TEST_F(OpenRecordingTest, WhatIsNoRecording) {
  EXPECT_THAT(error_of((folder_ / "missing").string()), HasSubstr("no such file"));
  EXPECT_THAT(error_of(folder_.string()), HasSubstr("is a directory"));
  EXPECT_THAT(error_of("/dev/null"), HasSubstr("is not a regular file"));
  EXPECT_THAT(error_of(file("empty", "")), HasSubstr("is empty"));
  EXPECT_THAT(error_of(file("text", "Dear diary,\nODOMETER\n")), HasSubstr("not a recording"));
  EXPECT_THAT(error_of(file("newlines", "\n\n\n")), HasSubstr("not a recording"));
  EXPECT_THAT(error_of(file("zeros", std::string(100'000, '\0'))), HasSubstr("not a recording"));
  EXPECT_THAT(error_of(file("cut.gz", "\x1F\x8B\x08")), HasSubstr("the gzip data is cut off at byte 3"));
  EXPECT_THAT(error_of(file("odd.gz", "\x1F\x8B rubbish that goes on")),
              HasSubstr("the gzip data is damaged"));
  EXPECT_THAT(error_of(file("long", std::string(1'000'000, 'x'))), HasSubstr("not a recording"));
}

TEST_F(OpenRecordingTest, AMessageTooLargeForMemoryIsPassedOver) {
  using test::McapBuilder;
  const std::uint64_t size = McapStream::kMaxSize + 1;
  const std::string path = file("large", McapBuilder::magic() + '\x05' + test::le(size));
  std::filesystem::resize_file(path, McapBuilder::magic().size() + 9 + size);  // a hole, which takes no disk
  std::ofstream(path, std::ios::binary | std::ios::app) << McapBuilder::record(0x0F, std::string(4, '\0'));
  const auto recording = open_recording(path);
  EXPECT_LT(recording->progress(), 0.1);
  const test::Contents all = test::read_all(*recording);
  EXPECT_EQ(all.counters["mcap.too_large"], 1U);
  EXPECT_EQ(all.damage, std::nullopt);
  EXPECT_EQ(recording->progress(), 1.0);
}

TEST_F(OpenRecordingTest, WhatMayNotBeRead) {
  const std::string path = file("secret", "FLASER");
  std::filesystem::permissions(path, std::filesystem::perms::none);
  if (geteuid() == 0) GTEST_SKIP() << "root reads everything";
  EXPECT_THAT(error_of(path), HasSubstr("cannot be read"));
}

/// Gives some bytes, then fails like a dying card.
class FailingSource final : public ByteSource {
 public:
  FailingSource(std::string bytes, std::size_t good) : inner_(std::move(bytes)), good_(good) {}
  std::size_t read(void* to, std::size_t size) override {
    const auto left = static_cast<std::size_t>(good_ > inner_.position() ? good_ - inner_.position() : 0);
    if (size > left) failed_ = true;
    return inner_.read(to, std::min(size, left));
  }
  void seek(std::uint64_t offset) override {
    inner_.seek(offset);
    failed_ = false;
  }
  std::uint64_t position() const override { return inner_.position(); }
  std::uint64_t size() const override { return inner_.size(); }
  std::string fault() const override { return failed_ ? "Input/output error" : ""; }
  const std::string& name() const override { return inner_.name(); }

 private:
  MemorySource inner_;
  std::size_t good_;
  bool failed_ = false;
};

TEST(FailingMediumTest, CarmenLogGivesWhatCameBefore) {
  std::string text;
  for (int i = 0; i < 10'000; ++i) text += "FLASER 1 2.0 0 0 0 0 0 0 1 h 1\n";
  const auto log = open_recording(std::make_unique<FailingSource>(text, text.size() / 2));
  const test::Contents carmen = test::read_all(*log);
  EXPECT_GT(carmen.scans.size(), 4000U);
  EXPECT_THAT(carmen.damage.value_or(""), HasSubstr("Input/output error"));
  EXPECT_THROW(open_recording(std::make_unique<FailingSource>(text, 0)), InputError);
}

TEST(FailingMediumTest, McapGivesWhatCameBefore) {
  for (const auto& compression : {std::optional<std::string>(""), std::optional<std::string>()}) {
    test::McapBuilder file({compression, 10, true, true});
    const auto scans = file.add_channel("/scan", "sensor_msgs/msg/LaserScan");
    for (int i = 0; i < 5000; ++i) file.add_message(scans, 1, test::laser_scan({}));
    const std::string bytes = file.finish();
    for (const std::size_t good :
         {bytes.size() / 50, bytes.size() / 2}) {  // while looking ahead, and after it
      const auto mcap = open_recording(std::make_unique<FailingSource>(bytes, good));
      const test::Contents all = test::read_all(*mcap);
      const double share = static_cast<double>(good) / static_cast<double>(bytes.size());
      EXPECT_NEAR(static_cast<double>(all.scans.size()), 5000.0 * share, 20.0);
      EXPECT_THAT(all.damage.value_or(""), HasSubstr("Input/output error"));
    }
  }
}

}  // namespace
}  // namespace dynslam
