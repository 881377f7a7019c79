// SPDX-License-Identifier: MIT
// What is kept over a restart.
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "server/access/access.h"

namespace dynslam {
namespace {

namespace fs = std::filesystem;
using std::chrono::hours;
using std::chrono::minutes;
using std::chrono::seconds;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr AccessTime kStart{std::chrono::steady_clock::time_point(seconds(1000)),
                            WallTime(std::chrono::days(21000))};
AccessTime later(seconds by) { return {kStart.steady + by, kStart.wall + by}; }

class AccessStateTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "dynslam-access-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
    file_ = folder_ / "access.json";
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::unique_ptr<Access> start() const {
    AccessSetup setup;
    setup.folder = folder_.string();
    return std::make_unique<Access>(std::move(setup));
  }
  Admission pair_owner(Access& access) const {
    return access.pair(access.owner_code(kStart)->text, "Anna's phone", "127.0.0.1", kStart);
  }
  static AccessRequest request(const Admission& admission) {
    return {"127.0.0.1", "GET", false, "localhost", {}, "dynslam_session=" + admission.secret, {}};
  }
  std::string text() const {
    std::ostringstream out;
    out << std::ifstream(file_, std::ios::binary).rdbuf();
    return out.str();
  }
  void write(const std::string& bytes) const { std::ofstream(file_, std::ios::binary) << bytes; }
  std::string refusal() const {
    try {
      start();
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  fs::path folder_, file_;
};

TEST_F(AccessStateTest, IsThereAfterARestart) {
  auto access = start();
  const Admission owner = pair_owner(*access);
  const Admission token = access->make_token("script", Role::kViewer, kStart);
  const Admission gone = access->make_token("gone", Role::kViewer, kStart);
  access->revoke(gone.credential.id);
  const auto before = access->credentials(kStart);
  access.reset();
  access = start();
  EXPECT_EQ(access->credentials(kStart), before);
  EXPECT_EQ(before.size(), 2U);
  EXPECT_FALSE(access->owner_code(kStart));
  EXPECT_TRUE(access->judge(request(owner), Role::kAdmin, kStart).is_in());
  EXPECT_TRUE(
      access
          ->judge({"::1", "GET", false, "localhost", {}, {}, "Bearer " + token.secret}, Role::kViewer, kStart)
          .is_in());
}

TEST_F(AccessStateTest, IsWrittenBeforeTheAnswer) {
  const auto access = start();
  EXPECT_FALSE(fs::exists(file_)) << "nothing to keep yet";
  const Admission owner = pair_owner(*access);
  EXPECT_THAT(text(), AllOf(HasSubstr("Anna's phone"), HasSubstr(hex_of(digest_of(owner.secret))),
                            Not(HasSubstr(owner.secret))));
  access->revoke(owner.credential.id);
  EXPECT_THAT(text(), Not(HasSubstr("Anna's phone")));
}

TEST_F(AccessStateTest, IsNobodyElsesBusiness) {
  const mode_t old = umask(0);
  pair_owner(*start());
  umask(old);
  struct stat file {};
  ASSERT_EQ(stat(file_.c_str(), &file), 0);
  EXPECT_EQ(file.st_mode & 0777U, 0600U);
}

TEST_F(AccessStateTest, HoldsNoPairingCode) {
  const auto access = start();
  pair_owner(*access);
  const PairingCode code = access->invite(Role::kViewer, kStart);
  access->make_token("script", Role::kViewer, kStart);
  EXPECT_THAT(text(), Not(HasSubstr(code.text)));
}

TEST_F(AccessStateTest, RemembersWhoWasSeen) {
  auto access = start();
  const Admission owner = pair_owner(*access);
  const std::string at_first = text();
  access->judge(request(owner), Role::kAdmin, later(hours(1)));
  access->tend(later(hours(1)));
  const std::string seen = text();
  EXPECT_NE(seen, at_first);
  access->judge(request(owner), Role::kAdmin, later(hours(1) + minutes(9)));
  access->tend(later(hours(1) + minutes(9)));
  EXPECT_EQ(text(), seen) << "not too often";
  access->tend(later(hours(1) + minutes(10)));
  EXPECT_NE(text(), seen);
  access->judge(request(owner), Role::kAdmin, later(hours(2)));
  access.reset();
  EXPECT_EQ(start()->credentials(kStart)[0].last_seen, later(hours(2)).wall) << "also at the end";
}

TEST_F(AccessStateTest, SetsAsideABrokenFileAndPairsAnew) {
  pair_owner(*start());
  const std::string good = text();
  std::vector<std::string> broken = {std::string(512, '\0'), "{}", "[]", "null", "\"x\"", good.substr(1)};
  for (std::size_t length = 0; length + 1 < good.size(); ++length) broken.push_back(good.substr(0, length));
  for (const std::string& bytes : broken) {
    write(bytes);
    const auto access = start();
    EXPECT_THAT(access->notice(), AllOf(HasSubstr("access.json.damaged"), Not(HasSubstr("\n")))) << bytes;
    EXPECT_TRUE(access->owner_code(kStart)) << "for who sees the console";
    EXPECT_TRUE(access->credentials(kStart).empty());
    if (bytes.size() % 64 == 0) {
      EXPECT_TRUE(pair_owner(*access).is_in());
    }
    fs::remove(file_);
    fs::remove(folder_ / "access.json.damaged");
  }
  write(good);
  EXPECT_EQ(start()->notice(), "");
}

TEST_F(AccessStateTest, BelongsToOneProgram) {
  const auto access = start();
  EXPECT_THAT(refusal(), HasSubstr("another run is writing there"));
}

TEST_F(AccessStateTest, DoesWithoutAFolder) {
  AccessSetup setup;
  setup.folder = "/proc/nowhere";
  Access access{std::move(setup)};
  EXPECT_THAT(access.trouble(), HasSubstr("/proc/nowhere"));
  EXPECT_TRUE(access.judge(request(pair_owner(access)), Role::kAdmin, kStart).is_in());
}

TEST_F(AccessStateTest, LetsInWhoCannotBeKeptUntilItEnds) {
  const auto access = start();
  const Admission token = access->make_token("script", Role::kViewer, kStart);
  fs::remove(file_);
  fs::create_directory(file_);  // now saving fails, for root too
  EXPECT_EQ(access->trouble(), "");
  const Admission owner = pair_owner(*access);
  EXPECT_TRUE(access->judge(request(owner), Role::kAdmin, kStart).is_in());
  EXPECT_THAT(access->trouble(), HasSubstr("cannot write to "));
  const Judgement revoked = access->revoke(token.credential.id);
  EXPECT_EQ(revoked.status, 500);
  EXPECT_THAT(revoked.why, HasSubstr("revoked, but only until the program ends: cannot write to "));
  EXPECT_EQ(access->credentials(kStart).size(), 1U) << "revoked all the same";
  access->tend(kStart);
  EXPECT_EQ(access->counts()["access.not_saved"], 3U);
  fs::remove(file_);
  access->tend(later(minutes(1)));
  EXPECT_EQ(access->trouble(), "");
  EXPECT_THAT(text(), HasSubstr("Anna's phone"));
}

/// As a Pi does that keeps no time while it is off.
TEST_F(AccessStateTest, StartsWithAClockThatIsNotSetYet) {
  const AccessTime unset{kStart.steady, WallTime(minutes(3))};
  const auto at = [&](WallTime wall, seconds passed) { return AccessTime{kStart.steady + passed, wall}; };
  auto access = start();
  const Admission owner = pair_owner(*access);
  access.reset();

  access = start();
  EXPECT_TRUE(access->judge(request(owner), Role::kAdmin, unset).is_in());
  access.reset();
  access = start();
  EXPECT_TRUE(access->judge(request(owner), Role::kAdmin, later(hours(24))).is_in())
      << "as it was seen before";
  access.reset();

  access = start();
  EXPECT_TRUE(access->judge(request(owner), Role::kAdmin, unset).is_in());
  const WallTime late = kStart.wall + std::chrono::days(1000);
  EXPECT_TRUE(access->judge(request(owner), Role::kAdmin, at(late, seconds(9))).is_in())
      << "seen a moment ago";
  EXPECT_EQ(access->credentials(at(late, seconds(9)))[0].last_seen, late) << "and no later than now";
  access.reset();

  access = start();
  access->tend(unset);
  EXPECT_TRUE(access->credentials(at(late + std::chrono::days(91), seconds(9))).empty())
      << "not seen for long, by a clock that was right";
}

TEST_F(AccessStateTest, PairsWhileTheClockIsNotSetYet) {
  const AccessTime unset{kStart.steady, WallTime(minutes(3))};
  auto access = start();
  const Admission owner = access->pair(access->owner_code(unset)->text, "phone", "127.0.0.1", unset);
  access.reset();
  access = start();
  EXPECT_TRUE(access->judge(request(owner), Role::kAdmin, {kStart.steady, WallTime(std::chrono::days(22000))})
                  .is_in());
}

TEST_F(AccessStateTest, TriesAgainToSave) {
  const auto access = start();
  const Admission token = access->make_token("script", Role::kViewer, kStart);
  fs::remove(file_);
  fs::create_directory(file_);
  access->revoke(token.credential.id);
  fs::remove(file_);
  access->tend(kStart);
  EXPECT_THAT(text(), AllOf(HasSubstr("credentials"), Not(HasSubstr("script"))));
}

}  // namespace
}  // namespace dynslam
