// SPDX-License-Identifier: MIT
#include "server/access/access.h"

#include <atomic>
#include <thread>

#include <gtest/gtest.h>

#include "base/error.h"

namespace dynslam {
namespace {

using std::chrono::hours;
using std::chrono::seconds;

constexpr AccessTime kStart{std::chrono::steady_clock::time_point(seconds(1000)),
                            std::chrono::sys_seconds(std::chrono::days(20000))};

AccessTime later(seconds by) { return {kStart.steady + by, kStart.wall + by}; }

AccessSetup setup(bool trust_loopback = false) {
  AccessSetup s;
  s.host_name = "robbie";
  s.trust_loopback = trust_loopback;
  return s;
}

AccessRequest request(const std::string& address = "192.168.1.5") {
  return {address, "GET", false, "robbie.local:8080", {}, {}, {}};
}

/// What a browser sends back of a Set-Cookie.
std::string pair_of(const std::string& set_cookie) { return set_cookie.substr(0, set_cookie.find(';')); }

AccessRequest with_cookie(const Admission& admission) {
  AccessRequest r = request();
  r.cookie = pair_of(admission.set_cookie);
  return r;
}

AccessRequest with_bearer(const std::string& secret, const std::string& address = "192.168.1.5") {
  AccessRequest r = request(address);
  r.authorization = "Bearer " + secret;
  return r;
}

/// A robot with an owner.
struct Robot {
  explicit Robot(bool trust_loopback = false) : access(setup(trust_loopback)) {
    owner = access.pair(access.owner_code(kStart)->text, "Anna's phone", "192.168.1.5", kStart);
  }
  Admission invited(Role role) {
    return access.pair(access.invite(role, kStart).text, "guest", "192.168.1.6", kStart);
  }
  int status(const AccessRequest& r, Role needed, const AccessTime& now = kStart) {
    const Judgement judgement = access.judge(r, needed, now);
    EXPECT_EQ(judgement.why.empty(), judgement.is_in());
    return judgement.status;
  }

  Access access;
  Admission owner;
};

TEST(Access, HasNoWayInButTheCodeAtTheStart) {
  Access access(setup());
  EXPECT_EQ(access.judge(request(), Role::kViewer, kStart).status, 401);
  EXPECT_EQ(access.judge(request("127.0.0.1"), Role::kViewer, kStart).status, 401);
  EXPECT_EQ(access.judge(request(), Role::kNone, kStart).status, 200);
  const auto code = access.owner_code(kStart);
  ASSERT_TRUE(code);
  EXPECT_TRUE(code->makes_owner);
  EXPECT_EQ(access.owner_code(later(hours(23)))->text, code->text) << "as long as it lasts";
  EXPECT_NE(access.owner_code(later(hours(24)))->text, code->text) << "then there is a new one";
}

TEST(Access, MakesTheOwner) {
  Access access(setup());
  const PairingCode code = access.owner_code(kStart).value();
  const Admission owner = access.pair(code.text, "Anna's phone", "192.168.1.5", kStart);
  ASSERT_EQ(owner.status, 200) << owner.why;
  EXPECT_EQ(owner.credential.role, Role::kAdmin);
  EXPECT_EQ(owner.set_cookie,
            "dynslam_session=" + owner.secret + "; Path=/; HttpOnly; SameSite=Strict; Max-Age=34560000");
  EXPECT_FALSE(access.owner_code(kStart));
  EXPECT_EQ(access.pair(code.text, "Eve", "192.168.1.6", kStart).status, 401) << "once";
  const Judgement judgement = access.judge(with_cookie(owner), Role::kAdmin, kStart);
  EXPECT_TRUE(judgement.is_in());
  EXPECT_EQ(judgement.role, Role::kAdmin);
  EXPECT_EQ(judgement.id, owner.credential.id);
  EXPECT_EQ(judgement.name, "Anna's phone");
}

TEST(Access, LetsEachRoleDoWhatItMay) {
  Robot robot;
  const Role roles[] = {Role::kNone, Role::kViewer, Role::kDriver, Role::kAdmin};
  for (const Role role : {Role::kViewer, Role::kDriver, Role::kAdmin}) {
    const Admission session = robot.invited(role);
    const Admission token = robot.access.make_token("script", role, kStart);
    for (const Role needed : roles) {
      const int expected = role >= needed ? 200 : 403;
      EXPECT_EQ(robot.status(with_cookie(session), needed), expected) << to_string(role) << to_string(needed);
      EXPECT_EQ(robot.status(with_bearer(token.secret), needed), expected);
    }
  }
  for (const Role needed : roles)
    EXPECT_EQ(robot.status(request(), needed), needed == Role::kNone ? 200 : 401);
}

TEST(Access, SaysWhoAndWhy) {
  Robot robot;
  const Admission viewer = robot.invited(Role::kViewer);
  EXPECT_EQ(robot.access.judge(with_cookie(viewer), Role::kAdmin, kStart).why,
            "this needs an admin, and guest is a viewer");
  EXPECT_EQ(robot.access.judge(request(), Role::kViewer, kStart).why,
            "this needs a paired browser or a token");
  EXPECT_EQ(robot.access.judge(with_bearer("x"), Role::kViewer, kStart).why,
            "the session or token is not valid, or not any more");
  const Counters counts = robot.access.counts();
  EXPECT_EQ(counts["access.role_too_low"], 1U);
  EXPECT_EQ(counts["access.not_signed_in"], 2U);
}

TEST(Access, KnowsForgedCookiesAndTokens) {
  Robot robot;
  const std::string secret = robot.owner.secret;
  std::string flipped = secret;
  flipped[20] = flipped[20] == 'A' ? 'B' : 'A';
  const std::string forged[] = {"",
                                "x",
                                secret.substr(1),
                                secret.substr(0, 42),
                                secret + "A",
                                flipped,
                                hex_of(robot.owner.credential.digest),
                                robot.owner.credential.id,
                                std::string(43, 'A'),
                                std::string(100000, 'A'),
                                "\"" + secret + "\"",
                                secret.substr(0, 21) + '\0' + secret.substr(22)};
  for (const std::string& one : forged) {
    AccessRequest r = request();
    r.cookie = "dynslam_session=" + one;
    EXPECT_EQ(robot.status(r, Role::kViewer), 401) << one.substr(0, 60);
    EXPECT_EQ(robot.status(r, Role::kNone), 200) << "who needs nothing is not refused for it";
    EXPECT_EQ(robot.status(with_bearer(one), Role::kViewer), 401) << one.substr(0, 60);
  }
  EXPECT_EQ(robot.status(with_bearer(secret), Role::kViewer), 401) << "a session is no token";
  const Admission token = robot.access.make_token("script", Role::kAdmin, kStart);
  AccessRequest r = request();
  r.cookie = "dynslam_session=" + token.secret;
  EXPECT_EQ(robot.status(r, Role::kViewer), 401) << "a token is no session";
  r.cookie = "theme=dark; dynslam_session=forged; " + pair_of(robot.owner.set_cookie);
  EXPECT_EQ(robot.status(r, Role::kAdmin), 200) << "what other pages set does no harm";
}

TEST(Access, TakesATokenBeforeACookie) {
  Robot robot;
  const Admission viewer = robot.access.make_token("script", Role::kViewer, kStart);
  AccessRequest r = with_cookie(robot.owner);
  r.authorization = "Bearer " + viewer.secret;
  EXPECT_EQ(robot.access.judge(r, Role::kViewer, kStart).name, "script");
  EXPECT_EQ(robot.status(r, Role::kAdmin), 403);
  r.authorization = "Bearer " + viewer.secret.substr(1);
  EXPECT_EQ(robot.status(r, Role::kViewer), 401);
  r.authorization = "Basic eDp5";
  EXPECT_EQ(robot.status(r, Role::kAdmin), 200) << "of a proxy's";
}

TEST(Access, RefusesStrangePlacesBeforeAnyCredential) {
  Robot robot;
  AccessRequest far = with_cookie(robot.owner);
  far.address = "8.8.8.8";
  AccessRequest rebound = with_cookie(robot.owner);
  rebound.host = "evil.org";
  AccessRequest foreign = with_cookie(robot.owner);
  foreign.method = "POST";
  foreign.origin = "http://evil.org";
  for (const AccessRequest& r : {far, rebound, foreign})
    for (const Role needed : {Role::kNone, Role::kAdmin}) EXPECT_EQ(robot.status(r, needed), 403);
  EXPECT_EQ(robot.access.counts()["access.far_client"], 2U);
  EXPECT_EQ(robot.access.counts()["access.foreign_host"], 2U);
  EXPECT_EQ(robot.access.counts()["access.foreign_origin"], 2U);
}

TEST(Access, LetsAnybodyNearStopTheRobot) {
  Robot robot;
  for (const char* origin : {static_cast<const char*>(nullptr), "http://evil.org", "null"}) {
    for (const char* cookie : {static_cast<const char*>(nullptr), "dynslam_session=forged"}) {
      AccessRequest r = request();
      r.method = "POST";
      if (origin != nullptr) r.origin = origin;
      if (cookie != nullptr) r.cookie = cookie;
      EXPECT_EQ(robot.access.judge_stop(r, kStart).status, 200);
    }
  }
  AccessRequest owner = with_cookie(robot.owner);
  owner.method = "POST";
  EXPECT_EQ(robot.access.judge_stop(owner, kStart).name, "Anna's phone");
  AccessRequest rebound = request();
  rebound.host = "evil.org";
  EXPECT_EQ(robot.access.judge_stop(rebound, kStart).status, 403);
  EXPECT_EQ(robot.access.judge_stop(request("8.8.8.8"), kStart).status, 403);
}

TEST(Access, TrustsThisMachineWhenTold) {
  Robot robot(true);
  for (const char* loopback : {"127.0.0.1", "::1", "::ffff:127.0.0.1"}) {
    const Judgement judgement = robot.access.judge(request(loopback), Role::kAdmin, kStart);
    EXPECT_EQ(judgement.status, 200);
    EXPECT_EQ(robot.access.why_ended(judgement.id, Role::kAdmin, kStart), "");
  }
  EXPECT_EQ(robot.status(request(), Role::kViewer), 401) << "only this machine";
  AccessRequest r = request("127.0.0.1");
  r.cookie = "dynslam_session=of-another-robot-on-this-machine";
  EXPECT_EQ(robot.status(r, Role::kAdmin), 200);
  r.host = "evil.org";
  EXPECT_EQ(robot.status(r, Role::kViewer), 403) << "rebound";
  r.host = "localhost:8080";
  r.method = "POST";
  r.origin = "http://evil.org";
  EXPECT_EQ(robot.status(r, Role::kViewer), 403) << "a foreign page in a browser here";
  const Admission viewer = robot.access.make_token("script", Role::kViewer, kStart);
  EXPECT_EQ(robot.status(with_bearer(viewer.secret, "127.0.0.1"), Role::kAdmin), 403)
      << "who shows a token is its holder";
  EXPECT_EQ(Robot().access.why_ended(Access::kLoopbackId, Role::kViewer, kStart),
            "signed out, or not seen for too long");
}

TEST(Access, InvitesWithACodeThatExpires) {
  Robot robot;
  const PairingCode early = robot.access.invite(Role::kDriver, kStart);
  const PairingCode late = robot.access.invite(Role::kDriver, kStart);
  EXPECT_EQ(robot.access.pair(early.text, "Ben", "10.0.0.1", later(seconds(15 * 60 - 1))).status, 200);
  EXPECT_EQ(robot.access.pair(late.text, "Ben", "10.0.0.1", later(seconds(15 * 60))).status, 401);
}

TEST(Access, SlowsDownWhoGuesses) {
  Robot robot;
  const PairingCode code = robot.access.invite(Role::kDriver, kStart);
  const auto pair = [&](const std::string& text, const std::string& address, int second) {
    return robot.access.pair(text, "guest", address, later(seconds(second)));
  };
  EXPECT_EQ(pair("0000-0000", "10.0.0.1", 0).status, 401);
  EXPECT_EQ(pair("garbage", "10.0.0.1", 1).status, 401);
  const Admission waits = pair(code.text, "10.0.0.1", 2);
  EXPECT_EQ(waits.status, 429) << "the right code too, or guessing were free";
  EXPECT_EQ(waits.retry_after_s, 1);
  EXPECT_EQ(waits.why, "too many wrong codes; try again in 1 s");
  EXPECT_EQ(robot.status(with_cookie(robot.owner), Role::kAdmin), 200) << "who is in stays in";
  EXPECT_EQ(pair(code.text, "10.0.0.2", 2).status, 200) << "from elsewhere at once";
  EXPECT_EQ(pair("0000-0000", "no address", 2).status, 401);
  EXPECT_EQ(pair("0000-0000", "nor this", 2).status, 429) << "these count as one";
  EXPECT_EQ(robot.access.counts()["access.wrong_code"], 3U);
  EXPECT_EQ(robot.access.counts()["access.must_wait"], 2U);
}

TEST(Access, RefusesNamesThatCannotBeShown) {
  Robot robot;
  const PairingCode code = robot.access.invite(Role::kDriver, kStart);
  for (const std::string& bad :
       {std::string(), std::string(65, 'x'), std::string("a\nb"), std::string("\xff")}) {
    EXPECT_EQ(robot.access.pair(code.text, bad, "10.0.0.1", kStart).status, 422);
    EXPECT_EQ(robot.access.make_token(bad, Role::kViewer, kStart).status, 422);
  }
  EXPECT_EQ(robot.access.pair(code.text, "good", "10.0.0.1", kStart).status, 200)
      << "the code was not used up";
}

TEST(Access, RevokesAtOnce) {
  Robot robot;
  const Admission driver = robot.invited(Role::kDriver);
  const std::string id = driver.credential.id;
  EXPECT_EQ(robot.access.why_ended(id, Role::kDriver, kStart), "");
  EXPECT_EQ(robot.access.why_ended(id, Role::kAdmin, kStart), "this needs an admin");
  EXPECT_EQ(robot.access.credentials(kStart).size(), 2U);
  EXPECT_EQ(robot.access.revoke(id).status, 200);
  EXPECT_EQ(robot.status(with_cookie(driver), Role::kViewer), 401);
  EXPECT_EQ(robot.access.why_ended(id, Role::kViewer, kStart), "signed out, or not seen for too long");
  EXPECT_EQ(robot.access.why_ended("", Role::kViewer, kStart), "signed out, or not seen for too long");
  EXPECT_EQ(robot.access.why_ended("", Role::kNone, kStart), "");
  EXPECT_EQ(robot.access.revoke(id).status, 404);
  EXPECT_EQ(robot.access.revoke(Access::kLoopbackId).status, 404);
  EXPECT_EQ(robot.access.credentials(kStart).size(), 1U);
  EXPECT_EQ(Access::clearing_cookie(), "dynslam_session=; Path=/; HttpOnly; SameSite=Strict; Max-Age=0");
}

TEST(Access, ShowsANewCodeWhenTheLastAdminIsGone) {
  Robot robot;
  EXPECT_FALSE(robot.access.owner_code(kStart));
  robot.access.revoke(robot.owner.credential.id);
  const auto code = robot.access.owner_code(kStart);
  ASSERT_TRUE(code);
  const PairingCode at_console = robot.access.invite(Role::kAdmin, kStart);
  EXPECT_EQ(robot.access.pair(at_console.text, "Anna's new phone", "10.0.0.1", kStart).status, 200);
  EXPECT_EQ(robot.access.pair(code->text, "Eve", "10.0.0.2", kStart).status, 401)
      << "what is printed makes no second owner";
}

TEST(Access, EndsASessionThatIsNotUsed) {
  Robot robot;
  const seconds day = hours(24);
  EXPECT_EQ(robot.status(with_cookie(robot.owner), Role::kAdmin, later(89 * day)), 200);
  EXPECT_EQ(robot.access.credentials(later(89 * day))[0].last_seen, later(89 * day).wall);
  EXPECT_EQ(robot.access.why_ended(robot.owner.credential.id, Role::kAdmin, later(170 * day)), "")
      << "an open socket is use";
  EXPECT_EQ(robot.status(with_cookie(robot.owner), Role::kAdmin, later(260 * day)), 401);
}

TEST(Access, HoldsOnlySoMany) {
  Robot robot;
  for (int i = 0; i < 255; ++i) ASSERT_EQ(robot.access.make_token("t", Role::kViewer, kStart).status, 200);
  const PairingCode code = robot.access.invite(Role::kViewer, kStart);
  EXPECT_EQ(robot.access.make_token("t", Role::kViewer, kStart).status, 409);
  EXPECT_EQ(robot.access.pair(code.text, "late", "10.0.0.1", kStart).status, 409);
  robot.access.revoke(robot.access.credentials(kStart)[9].id);
  EXPECT_EQ(robot.access.pair(code.text, "late", "10.0.0.1", kStart).status, 200) << "the code still works";
  EXPECT_EQ(robot.access.make_token("t", Role::kViewer, later(hours(91 * 24))).status, 200)
      << "expired ones make room";
}

TEST(Access, AClockThatJumpsByYearsSignsNobodyOut) {
  Robot robot;
  const Admission idle = robot.invited(Role::kViewer);
  AccessTime now = kStart;
  for (const int years : {40, -40, -50, 50, 1, -1, 40, -40, -54, 54, 30, -30}) {
    now.steady += seconds(10);
    now.wall += seconds(10) + std::chrono::years(years);
    EXPECT_EQ(robot.status(with_cookie(robot.owner), Role::kAdmin, now), 200) << years;
    EXPECT_EQ(robot.access.why_ended(idle.credential.id, Role::kViewer, now), "") << years;
    EXPECT_FALSE(robot.access.owner_code(now));
  }
  for (const Credential& one : robot.access.credentials(now))
    EXPECT_LT(one.last_seen, kStart.wall + std::chrono::years(41)) << "the latest that the clock ever said";
}

TEST(Access, AThreadThatReadTheClockBeforeItWasSetTakesNothingBack) {
  Robot robot;
  const AccessTime set{kStart.steady + seconds(10), kStart.wall + std::chrono::years(50)};
  EXPECT_EQ(robot.status(with_cookie(robot.owner), Role::kAdmin, set), 200);
  EXPECT_EQ(robot.status(with_cookie(robot.owner), Role::kAdmin, later(seconds(9))), 200);
  EXPECT_EQ(robot.access.credentials(set)[0].last_seen, set.wall);
}

TEST(Access, NoticesThatTheMachineMoved) {
  Robot robot;
  AccessRequest r = with_cookie(robot.owner);
  r.address = "2001:db8::5";
  EXPECT_EQ(robot.status(r, Role::kViewer), 403);
  robot.access.set_addresses({"2001:db8::7/64"});
  EXPECT_EQ(robot.status(r, Role::kViewer), 200);
}

TEST(Access, RefusesAConfigThatCannotBe) {
  AccessSetup s = setup();
  s.config.client_networks = {"everywhere"};
  EXPECT_THROW(Access{std::move(s)}, InputError);
}

TEST(Access, IsSafeFromManyThreads) {
  Robot robot;
  constexpr int kThreads = 8, kRounds = 100;
  std::vector<std::string> codes;
  for (int i = 0; i < 4; ++i) codes.push_back(robot.access.invite(Role::kDriver, kStart).text);
  std::atomic<int> paired{0}, in{0}, revoked{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([&, t] {
      // All want the first code; one gets it and then, as the others must wait, the rest.
      for (const std::string& code : codes)
        if (robot.access.pair(code, "racer", "10.0.1." + std::to_string(t), kStart).is_in()) ++paired;
      for (int i = 0; i < kRounds; ++i) {
        const Admission token = robot.access.make_token("t", Role::kViewer, kStart);
        if (robot.access.judge(with_bearer(token.secret), Role::kViewer, kStart).is_in()) ++in;
        if (robot.access.revoke(token.credential.id).is_in()) ++revoked;
        if (robot.access.judge(with_bearer(token.secret), Role::kViewer, kStart).is_in()) --in;
        robot.access.judge(with_cookie(robot.owner), Role::kAdmin, later(hours(i)));
        robot.access.credentials(kStart);
        robot.access.set_addresses({"2001:db8::7/64"});
        robot.access.owner_code(kStart);
        robot.access.tend(kStart);
        robot.access.counts();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(in, kThreads * kRounds);
  EXPECT_EQ(revoked, kThreads * kRounds);
  EXPECT_EQ(paired, 4);
}

}  // namespace
}  // namespace dynslam
