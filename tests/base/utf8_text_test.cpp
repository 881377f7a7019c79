// SPDX-License-Identifier: MIT
#include "base/utf8_text.h"

#include <string>

#include <gtest/gtest.h>

namespace dynslam {
namespace {

TEST(PlainCharacters, CountsCharactersAndNotBytes) {
  EXPECT_EQ(plain_characters(""), 0U);
  EXPECT_EQ(plain_characters("robot 7"), 7U);
  EXPECT_EQ(plain_characters("\xc3\xa4 \xe2\x82\xac \xf0\x9f\xa4\x96"), 5U);
}

TEST(PlainCharacters, TakesNoControlCharactersAndNothingThatIsNoUtf8) {
  for (const std::string& bad :
       {std::string("a\nb"), std::string(1, '\0'), std::string("\x7f"), std::string("\xc2\x85"),
        std::string("a\xff"), std::string("\xc3"), std::string("\xc0\x80"), std::string("\xed\xa0\x80")})
    EXPECT_FALSE(plain_characters(bad)) << bad.size();
}

}  // namespace
}  // namespace dynslam
