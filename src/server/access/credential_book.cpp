// SPDX-License-Identifier: MIT
#include "server/access/credential_book.h"

#include <algorithm>
#include <cstdint>
#include <set>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/utf8_text.h"

namespace dynslam {
namespace {

using nlohmann::json;
using Kind = Credential::Kind;

constexpr int kVersion = 1;
constexpr WallTime kWritten = std::chrono::sys_days(std::chrono::year(2026) / 1 / 1);
constexpr std::chrono::minutes kSeenAgainAfter{1};  // what "last seen" is good to
constexpr std::int64_t kLatest_s = 253402300799;    // the end of the year 9999

constexpr std::string_view to_string(Kind kind) { return kind == Kind::kSession ? "session" : "token"; }

json json_of(const Credential& c) {
  return {{"id", c.id},
          {"kind", to_string(c.kind)},
          {"name", c.name},
          {"role", to_string(c.role)},
          {"digest", hex_of(c.digest)},
          {"created_s", c.created.time_since_epoch().count()},
          {"last_seen_s", c.last_seen.time_since_epoch().count()}};
}

[[noreturn]] void fail(const std::string& what) { throw InputError(what); }

/// The library would turn fractions and numbers beyond all limits into something.
std::int64_t whole_number(const json& number) {
  if (!number.is_number_integer()) fail("something missing or of the wrong type");
  return number.get<std::int64_t>();
}

WallTime time_from(const json& number) {
  const std::int64_t seconds = whole_number(number);
  if (seconds < 0 || seconds > kLatest_s) fail("a time that cannot be");
  return WallTime(std::chrono::seconds(seconds));
}

Credential credential_from(const json& from) {
  Credential c;
  c.id = from.at("id").get<std::string>();
  const auto kind = from.at("kind").get<std::string>();
  if (kind != to_string(Kind::kSession) && kind != to_string(Kind::kToken)) fail("an unknown kind");
  c.kind = kind == to_string(Kind::kToken) ? Kind::kToken : Kind::kSession;
  c.name = from.at("name").get<std::string>();
  const auto role = role_named(from.at("role").get<std::string>());
  const auto digest = digest_from_hex(from.at("digest").get<std::string>());
  if (!role) fail("an unknown role");
  if (!digest || c.id.empty() || !is_name(c.name)) fail("a malformed credential");
  c.role = *role;
  c.digest = *digest;
  c.created = time_from(from.at("created_s"));
  c.last_seen = time_from(from.at("last_seen_s"));
  return c;
}

std::vector<Credential> credentials_from(const json& from) {
  if (whole_number(from.at("version")) != kVersion) fail("a version that this program does not know");
  std::vector<Credential> all;
  std::set<std::string> ids;
  for (const json& one : from.at("credentials").get_ref<const json::array_t&>()) {
    all.push_back(credential_from(one));
    if (!ids.insert(all.back().id).second) fail("the same id twice");
  }
  if (all.size() > CredentialBook::kMost) fail("too many credentials");
  return all;
}

}  // namespace

bool is_name(std::string_view text) {
  return !text.empty() && text.size() <= CredentialBook::kLongestName && plain_characters(text).has_value();
}

bool CredentialBook::remove(const std::string& id) {
  return std::erase_if(all_, [&](const Credential& c) { return c.id == id; }) > 0;
}

void CredentialBook::drop_expired(WallTime now) {
  std::erase_if(all_, [&](const Credential& c) { return !is_valid(c, now); });
}

Credential* CredentialBook::find(Kind kind, const Digest& digest, WallTime now) {
  Credential* found = nullptr;
  for (Credential& c : all_)
    if (is_same(c.digest, digest) && c.kind == kind && is_valid(c, now)) found = &c;
  return found;
}

Credential* CredentialBook::find(const std::string& id, WallTime now) {
  const auto found = std::find_if(all_.begin(), all_.end(), [&](const Credential& c) { return c.id == id; });
  return found != all_.end() && is_valid(*found, now) ? &*found : nullptr;
}

/// A clock that is behind what was seen already was set back, or is not set yet: what is kept stays.
bool CredentialBook::see(Credential& credential, WallTime now) {
  credential.seen_behind = now < credential.last_seen;
  if (now - credential.last_seen < kSeenAgainAfter) return false;
  credential.last_seen = now;
  return true;
}

void CredentialBook::begin(WallTime now) {
  for (Credential& c : all_)
    if (c.last_seen < kWritten) c.last_seen = std::max(c.last_seen, now);
}

void CredentialBook::put_forward(WallTime from, WallTime to) {
  for (Credential& c : all_) {
    if (c.last_seen <= from) c.last_seen += to - from;
    if (c.seen_behind) c.last_seen = std::max(c.last_seen, to);
    c.seen_behind = false;
  }
}

bool CredentialBook::has_admin(WallTime now) const {
  return std::any_of(all_.begin(), all_.end(),
                     [&](const Credential& c) { return c.role == Role::kAdmin && is_valid(c, now); });
}

std::vector<Credential> CredentialBook::all(WallTime now) const {
  std::vector<Credential> valid;
  for (const Credential& c : all_)
    if (is_valid(c, now)) valid.push_back(c);
  return valid;
}

std::string CredentialBook::to_json() const {
  json credentials = json::array();
  for (const Credential& c : all_) credentials.push_back(json_of(c));
  return json{{"version", kVersion}, {"credentials", credentials}}.dump(1) + '\n';
}

void CredentialBook::read_json(std::string_view text) {
  try {
    all_ = credentials_from(json::parse(text));
  } catch (const json::parse_error&) {
    fail("no whole JSON");
  } catch (const json::exception&) {
    fail("something missing or of the wrong type");
  }
}

/// A clock that was set back makes nothing invalid.
bool CredentialBook::is_valid(const Credential& credential, WallTime now) const {
  return credential.kind == Kind::kToken || now - credential.last_seen < session_lasts_;
}

}  // namespace dynslam
