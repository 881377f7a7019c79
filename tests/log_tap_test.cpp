// SPDX-License-Identifier: MIT
#include "log_tap.h"

#include <gtest/gtest.h>
#include <spdlog/sinks/null_sink.h>
#include <spdlog/spdlog.h>

namespace dynslam {
namespace {

TEST(LogTap, HandsOnWhatIsLoggedWhileItLives) {
  const auto before = spdlog::default_logger();
  spdlog::set_default_logger(
      std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::null_sink_mt>()));
  Ports ports;
  SteppedClock clock(time_at_s(3.0));
  spdlog::warn("too early");
  {
    const LogTap tap(ports, clock);
    spdlog::info("{} and {}", "one", 2);
    spdlog::critical("the end");
    spdlog::debug("below what is logged");
  }
  spdlog::warn("too late");
  spdlog::set_default_logger(before);
  const std::vector<LogLine> recent = ports.recent_log.all();
  ASSERT_EQ(recent.size(), 2U);
  EXPECT_EQ(recent[1].text, "the end");
  const auto first = ports.log.try_pop(), second = ports.log.try_pop();
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->text, "one and 2");
  EXPECT_EQ(first->time, time_at_s(3.0));
  EXPECT_EQ(first->level, LogLevel::kInfo);
  EXPECT_EQ(second->text, "the end");
  EXPECT_EQ(second->level, LogLevel::kFatal);
  EXPECT_FALSE(ports.log.try_pop());
}

}  // namespace
}  // namespace dynslam
