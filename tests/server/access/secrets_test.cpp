// SPDX-License-Identifier: MIT
#include "server/access/secrets.h"

#include <set>

#include <gtest/gtest.h>

#include "server/access/pairing_codes.h"

namespace dynslam {
namespace {

using std::chrono::seconds;

TEST(Secrets, AreNeverTheSame) {
  std::set<std::string> all;
  for (int i = 0; i < 100; ++i) {
    const std::string secret = new_secret();
    EXPECT_TRUE(is_secret(secret)) << secret;
    EXPECT_EQ(new_id().size(), 12U);
    all.insert({secret, new_id(), new_code()});
  }
  EXPECT_EQ(all.size(), 300U);
}

TEST(Secrets, HaveOneForm) {
  const std::string good(43, 'a');
  EXPECT_TRUE(is_secret(good));
  for (const std::string& bad : {std::string(), good + 'a', good.substr(1), good.substr(1) + '=',
                                 good.substr(1) + ' ', std::string(43, '\0'), std::string(1 << 20, 'a')})
    EXPECT_FALSE(is_secret(bad));
}

TEST(Digest, IsBlake2b) {
  // Known answer: BLAKE2b-256 of "abc", from `b2sum -l 256`.
  EXPECT_EQ(hex_of(digest_of("abc")), "bddd813c634239723171ef3fee98579b94964e3bb1cb3e427262c8c068d52319");
  EXPECT_TRUE(is_same(digest_of("abc"), digest_of("abc")));
  EXPECT_FALSE(is_same(digest_of("abc"), digest_of("abd")));
}

TEST(Digest, ReadsBackItsHex) {
  const Digest digest = digest_of("x");
  const std::string hex = hex_of(digest);
  EXPECT_EQ(digest_from_hex(hex), digest);
  for (const std::string& bad :
       {std::string(), hex + "00", hex.substr(2), hex.substr(1) + 'g', hex.substr(1) + 'A'})
    EXPECT_FALSE(digest_from_hex(bad)) << bad;
}

TEST(TypedCode, PutsRightWhatPeopleType) {
  for (const char* typed : {"ABCD0123", "abcd-0123", " ab cd-01 23 ", "ABCDO1Z3", "abcdoi23", "ABCDol23"}) {
    const auto code = typed_code(typed);
    ASSERT_TRUE(code) << typed;
    EXPECT_EQ(code->size(), 8U);
  }
  EXPECT_EQ(typed_code("abcd-oil0"), "ABCD0110");
  for (const char* bad : {"", "-", "ABCD012", "ABCD01234", "ABCDU123", "ABCD_123", "ABCD012\xc3\xa4"})
    EXPECT_FALSE(typed_code(bad)) << bad;
  EXPECT_FALSE(typed_code("ABCD0123" + std::string(100, ' '))) << "too long a text";
}

class PairingCodesTest : public testing::Test {
 protected:
  PairingCode add(Role role, bool makes_owner = false) {
    return codes_.add(role, makes_owner, now_ + seconds(60));
  }

  PairingCodes codes_;
  PairingCodes::SteadyTime now_{seconds(1000)};
};

TEST_F(PairingCodesTest, WorkOnce) {
  const PairingCode viewer = add(Role::kViewer), driver = add(Role::kDriver);
  EXPECT_EQ(viewer.text.size(), 9U);
  EXPECT_EQ(viewer.text[4], '-');
  const auto taken = codes_.take(driver.text, now_);
  ASSERT_TRUE(taken);
  EXPECT_EQ(taken->role, Role::kDriver);
  EXPECT_FALSE(codes_.take(driver.text, now_));
  EXPECT_TRUE(codes_.take(viewer.text, now_)) << "the other one still works";
}

TEST_F(PairingCodesTest, ExpireOnTime) {
  const PairingCode early = add(Role::kViewer), late = add(Role::kViewer);
  EXPECT_TRUE(codes_.take(early.text, now_ + seconds(60) - std::chrono::nanoseconds(1)));
  EXPECT_FALSE(codes_.take(late.text, now_ + seconds(60)));
}

TEST_F(PairingCodesTest, CanBePutBack) {
  const PairingCode code = add(Role::kViewer);
  codes_.put_back(*codes_.take(code.text, now_));
  EXPECT_TRUE(codes_.take(code.text, now_));
}

TEST_F(PairingCodesTest, AreBoundedButForTheOwners) {
  const PairingCode owner = add(Role::kAdmin, true), first = add(Role::kViewer), second = add(Role::kViewer);
  for (std::size_t i = 3; i <= PairingCodes::kMost; ++i) add(Role::kViewer);
  EXPECT_FALSE(codes_.take(first.text, now_)) << "pushed out";
  EXPECT_TRUE(codes_.take(second.text, now_));
  EXPECT_EQ(codes_.for_owner(now_)->text, owner.text);
  EXPECT_FALSE(codes_.for_owner(now_ + seconds(60)));
  codes_.drop_for_owner();
  EXPECT_FALSE(codes_.take(owner.text, now_));
}

}  // namespace
}  // namespace dynslam
