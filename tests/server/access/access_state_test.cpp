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
                            std::chrono::sys_seconds(std::chrono::days(20000))};
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

/// A stranger must not become the owner because a file broke.
TEST_F(AccessStateTest, DoesNotStartWithABrokenFile) {
  pair_owner(*start());
  const std::string good = text();
  for (const std::string& broken : {std::string(), good.substr(0, good.size() / 2), std::string(512, '\0'),
                                    std::string("{}"), std::string(2 << 20, ' ')}) {
    write(broken);
    EXPECT_THAT(refusal(), AllOf(HasSubstr(file_.string()), Not(HasSubstr("\n")), Not("no error")));
    EXPECT_EQ(text(), broken) << "left as it was";
  }
  write(good.substr(1));
  EXPECT_EQ(refusal(), "cannot use " + file_.string() +
                           ": it holds no whole JSON. It says who may use the robot, so it is left as it is; "
                           "move it away to pair anew");
  write(good);
  EXPECT_EQ(refusal(), "no error");
}

TEST_F(AccessStateTest, DoesNotStartWithWhatIsNoFile) {
  fs::create_directory(file_);
  EXPECT_EQ(refusal(), "cannot read " + file_.string() + ": it is no regular file");
  fs::remove(file_);
  fs::create_symlink(file_, file_);
  EXPECT_THAT(refusal(), HasSubstr("cannot read " + file_.string() + ": "));
}

TEST_F(AccessStateTest, BelongsToOneProgram) {
  const auto access = start();
  EXPECT_THAT(refusal(), HasSubstr("another run is writing there"));
}

TEST_F(AccessStateTest, NeedsAFolderThatCanBeWrittenTo) {
  AccessSetup setup;
  setup.folder = "/proc/nowhere";
  EXPECT_THROW(Access{std::move(setup)}, InputError);
}

TEST_F(AccessStateTest, LetsNobodyInWhoCannotBeKept) {
  const auto access = start();
  const std::string code = access->owner_code(kStart)->text;
  const Admission token = access->make_token("script", Role::kViewer, kStart);
  fs::remove(file_);
  fs::create_directory(file_);  // now saving fails, for root too
  const Admission failed = access->pair(code, "Anna's phone", "127.0.0.1", kStart);
  EXPECT_EQ(failed.status, 500);
  EXPECT_TRUE(failed.secret.empty());
  EXPECT_EQ(access->credentials(kStart).size(), 1U);
  EXPECT_EQ(access->make_token("late", Role::kViewer, kStart).status, 500);
  const Judgement revoked = access->revoke(token.credential.id);
  EXPECT_EQ(revoked.status, 500);
  EXPECT_THAT(revoked.why, HasSubstr("revoked, but only until the program ends: cannot write to "));
  EXPECT_TRUE(access->credentials(kStart).empty()) << "revoked all the same";
  EXPECT_EQ(access->counts()["access.not_saved"], 3U);
  fs::remove(file_);
  EXPECT_EQ(access->pair(code, "Anna's phone", "127.0.0.1", kStart).status, 200) << "the code still works";
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
