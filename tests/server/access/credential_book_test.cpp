// SPDX-License-Identifier: MIT
#include "server/access/credential_book.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace dynslam {
namespace {

using std::chrono::days;
using std::chrono::seconds;
using Kind = Credential::Kind;

constexpr WallTime kDay{days(20000)};

Credential credential(const std::string& id, Kind kind = Kind::kSession, Role role = Role::kViewer) {
  return {id, kind, "Anna's phone", role, digest_of(id), kDay, kDay};
}

CredentialBook book_of(std::initializer_list<Credential> all) {
  CredentialBook book{days(90)};
  for (const Credential& one : all) book.add(one);
  return book;
}

TEST(CredentialBook, FindsByTheSecretAndItsKind) {
  CredentialBook book = book_of({credential("a"), credential("b", Kind::kToken)});
  EXPECT_EQ(book.find(Kind::kSession, digest_of("a"), kDay)->id, "a");
  EXPECT_EQ(book.find(Kind::kToken, digest_of("b"), kDay)->id, "b");
  EXPECT_EQ(book.find(Kind::kToken, digest_of("a"), kDay), nullptr) << "a stolen cookie is no token";
  EXPECT_EQ(book.find(Kind::kSession, digest_of("b"), kDay), nullptr);
  EXPECT_EQ(book.find(Kind::kSession, digest_of("c"), kDay), nullptr);
  EXPECT_EQ(book.find("b", kDay)->name, "Anna's phone");
  EXPECT_EQ(book.find("c", kDay), nullptr);
}

TEST(CredentialBook, EndsSessionsThatNobodyUses) {
  CredentialBook book =
      book_of({credential("a", Kind::kSession, Role::kAdmin), credential("b", Kind::kToken)});
  const auto last = kDay + days(90) - seconds(1), end = kDay + days(90);
  EXPECT_NE(book.find("a", last), nullptr);
  EXPECT_TRUE(book.has_admin(last));
  EXPECT_EQ(book.find("a", end), nullptr);
  EXPECT_EQ(book.find(Kind::kSession, digest_of("a"), end), nullptr);
  EXPECT_FALSE(book.has_admin(end));
  EXPECT_NE(book.find("b", end + days(10000)), nullptr) << "tokens last";
  EXPECT_EQ(book.all(end).size(), 1U);
  EXPECT_NE(book.find("a", last), nullptr) << "the clock was wrong";
  EXPECT_NE(book.find("a", kDay - days(1000)), nullptr) << "and now it is wrong the other way";
  book.drop_expired(end);
  EXPECT_EQ(book.find("a", last), nullptr);
}

TEST(CredentialBook, ReadsBackItsJson) {
  CredentialBook book =
      book_of({credential("a", Kind::kSession, Role::kAdmin), credential("b", Kind::kToken)});
  book.find("a", kDay)->name = "J\xc3\xbcrgens \"Telefon\"";
  CredentialBook back{days(90)};
  back.read_json(book.to_json());
  EXPECT_EQ(back.all(kDay), book.all(kDay));
  back.read_json(CredentialBook{days(90)}.to_json());
  EXPECT_TRUE(back.all(kDay).empty());
}

TEST(CredentialBook, KeepsNoSecret) {
  const std::string secret = new_secret();
  Credential c = credential("a");
  c.digest = digest_of(secret);
  EXPECT_EQ(book_of({c}).to_json().find(secret), std::string::npos);
}

TEST(CredentialBook, SaysWhatIsWrongWithAJson) {
  const std::string good = book_of({credential("a"), credential("b")}).to_json();
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  };
  const std::string many = [] {
    CredentialBook book{days(90)};
    for (int i = 0; i < 257; ++i) book.add(credential(std::to_string(i)));
    return book.to_json();
  }();
  const std::pair<std::string, std::string> rows[] = {
      {"", "no whole JSON"},
      {std::string(4096, '\0'), "no whole JSON"},
      {good.substr(0, good.size() / 2), "no whole JSON"},
      {good + good, "no whole JSON"},
      {"\xff\xfe", "no whole JSON"},
      {std::string(100000, '['), "no whole JSON"},
      {"{}", "something missing or of the wrong type"},
      {"[]", "something missing or of the wrong type"},
      {"null", "something missing or of the wrong type"},
      {R"({"version":1,"credentials":{}})", "something missing or of the wrong type"},
      {R"({"version":1,"credentials":[1]})", "something missing or of the wrong type"},
      {R"({"version":"1","credentials":[]})", "something missing or of the wrong type"},
      {R"({"version":2,"credentials":[]})", "a version that this program does not know"},
      {with("\"viewer\"", "\"king\""), "an unknown role"},
      {with("\"viewer\"", "\"none\""), "an unknown role"},
      {with("\"viewer\"", "3"), "something missing or of the wrong type"},
      {with("\"session\"", "\"cookie\""), "an unknown kind"},
      {with("\"digest\": \"", "\"digest\": \"0"), "a malformed credential"},
      {with("\"id\": \"a\"", "\"id\": \"\""), "a malformed credential"},
      {with("Anna", "\\n"), "a malformed credential"},
      {with("\"id\": \"a\"", "\"id\": \"b\""), "the same id twice"},
      {with("\"created_s\": 1728000000", "\"created_s\": -1"), "a time that cannot be"},
      {with("\"last_seen_s\": 1728000000", "\"last_seen_s\": 253402300800"), "a time that cannot be"},
      {with("\"last_seen_s\": 1728000000", "\"last_seen_s\": 18446744073709551615"), "a time that cannot be"},
      {with("\"last_seen_s\": 1728000000", "\"last_seen_s\": 1e99"),
       "something missing or of the wrong type"},
      {with("\"version\": 1", "\"version\": 1e99"), "something missing or of the wrong type"},
      {many, "too many credentials"},
  };
  for (const auto& [text, message] : rows) {
    CredentialBook book = book_of({credential("old")});
    try {
      book.read_json(text);
      ADD_FAILURE() << "took " << text.substr(0, 300);
    } catch (const InputError& error) {
      EXPECT_EQ(error.what(), message) << text.substr(0, 300);
    }
    EXPECT_EQ(book.all(kDay).size(), 1U) << "changed by " << text.substr(0, 300);
  }
}

TEST(IsName, IsTextThatCanBeShown) {
  for (const std::string& good : {std::string("a"), std::string("Anna's phone"), std::string(64, 'x'),
                                  std::string("\xc3\xa4 \xe2\x82\xac \xf0\x9f\xa4\x96 \xc2\xa0")})
    EXPECT_TRUE(is_name(good)) << good;
  for (const std::string& bad :
       {std::string(), std::string(65, 'x'), std::string("a\nb"), std::string(1, '\0'), std::string("\x7f"),
        std::string("\xc2\x85"), std::string("\xff"), std::string("\xc3"), std::string("\xc0\x80"),
        std::string("\xed\xa0\x80"), std::string("\xe0\x80\x80"), std::string("\xf4\x90\x80\x80"),
        std::string("\xf0\x80\x80\x80"), std::string("\xc3\x28"), std::string("\xf5\x80\x80\x80")})
    EXPECT_FALSE(is_name(bad)) << hex_of(digest_of(bad)) << ' ' << bad.size();
}

}  // namespace
}  // namespace dynslam
