// SPDX-License-Identifier: MIT
#include "server/access/driver_lease.h"

#include <gtest/gtest.h>

namespace dynslam {
namespace {

using std::chrono::nanoseconds;
using std::chrono::seconds;
using Holder = DriverLease::Holder;

const Holder kAnna{1, "Anna"}, kBen{2, "Ben"}, kAnnasTablet{3, "Anna"};

class DriverLeaseTest : public testing::Test {
 protected:
  bool acquire(const Holder& who) { return lease_.acquire(who, false, now_).granted; }

  DriverLease lease_;
  DriverLease::SteadyTime now_{seconds(1000)};
};

TEST_F(DriverLeaseTest, IsFreeAtFirst) {
  EXPECT_FALSE(lease_.holder());
  EXPECT_FALSE(lease_.renew(1, now_));
  EXPECT_FALSE(lease_.release(1));
  const auto answer = lease_.acquire(kAnna, false, now_);
  EXPECT_TRUE(answer.granted);
  EXPECT_FALSE(answer.relieved);
  EXPECT_EQ(lease_.holder(), kAnna);
}

TEST_F(DriverLeaseTest, HasOneHolder) {
  EXPECT_TRUE(acquire(kAnna));
  EXPECT_TRUE(acquire(kAnna)) << "again";
  EXPECT_FALSE(acquire(kBen));
  EXPECT_FALSE(acquire(kAnnasTablet)) << "also of one person";
  EXPECT_FALSE(lease_.renew(2, now_));
  EXPECT_FALSE(lease_.release(2));
  EXPECT_EQ(lease_.holder(), kAnna);
}

TEST_F(DriverLeaseTest, IsTakenOverOnRequest) {
  acquire(kAnna);
  const auto answer = lease_.acquire(kBen, true, now_);
  EXPECT_TRUE(answer.granted);
  EXPECT_EQ(answer.relieved, kAnna);
  EXPECT_EQ(lease_.holder(), kBen);
  EXPECT_FALSE(lease_.renew(1, now_)) << "what Anna still sends counts no more";
  EXPECT_FALSE(lease_.release(1)) << "nor does her leaving";
  EXPECT_FALSE(lease_.acquire(kBen, true, now_).relieved) << "nobody is relieved by himself";
}

TEST_F(DriverLeaseTest, IsGivenOnceItsHolderIsIdle) {
  acquire(kAnna);
  now_ += DriverLease::kIdleAfter - nanoseconds(1);
  EXPECT_FALSE(acquire(kBen));
  EXPECT_TRUE(lease_.renew(1, now_));
  now_ += DriverLease::kIdleAfter - nanoseconds(1);
  EXPECT_FALSE(acquire(kBen)) << "heard of again";
  now_ += nanoseconds(1);
  EXPECT_EQ(lease_.holder(), kAnna) << "hers until somebody wants it";
  const auto answer = lease_.acquire(kBen, false, now_);
  EXPECT_TRUE(answer.granted);
  EXPECT_EQ(answer.relieved, kAnna);
}

TEST_F(DriverLeaseTest, IsFreeOnceLetGo) {
  acquire(kAnna);
  EXPECT_TRUE(lease_.release(1));
  EXPECT_FALSE(lease_.holder());
  EXPECT_TRUE(acquire(kBen));
}

}  // namespace
}  // namespace dynslam
