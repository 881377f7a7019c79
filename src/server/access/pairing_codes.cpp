// SPDX-License-Identifier: MIT
#include "server/access/pairing_codes.h"

#include <algorithm>
#include <utility>

#include "server/access/secrets.h"

namespace dynslam {
namespace {

constexpr std::size_t kHalf = 4;

bool is_code(const PairingCode& code, const Digest& typed) {
  const auto plain = typed_code(code.text);
  return plain && is_same(digest_of(*plain), typed);
}

}  // namespace

PairingCode PairingCodes::add(Role role, bool makes_owner, SteadyTime expires) {
  const std::string letters = new_code();
  std::string text = letters.substr(0, kHalf) + '-' + letters.substr(kHalf);
  // The owner's does not give way: it is on paper or in a journal by now.
  if (codes_.size() >= kMost) {
    const auto oldest =
        std::find_if(codes_.begin(), codes_.end(), [](const PairingCode& c) { return !c.makes_owner; });
    if (oldest != codes_.end()) codes_.erase(oldest);
  }
  codes_.push_back({std::move(text), role, makes_owner, expires});
  return codes_.back();
}

std::optional<PairingCode> PairingCodes::take(std::string_view typed, SteadyTime now) {
  drop_expired(now);
  const auto plain = typed_code(typed);
  if (!plain) return std::nullopt;
  const Digest digest = digest_of(*plain);
  auto found = codes_.end();
  for (auto code = codes_.begin(); code != codes_.end(); ++code)
    if (is_code(*code, digest)) found = code;
  if (found == codes_.end()) return std::nullopt;
  PairingCode taken = std::move(*found);
  codes_.erase(found);
  return taken;
}

std::optional<PairingCode> PairingCodes::for_owner(SteadyTime now) const {
  const auto found = std::find_if(codes_.begin(), codes_.end(),
                                  [&](const PairingCode& c) { return c.makes_owner && now < c.expires; });
  if (found == codes_.end()) return std::nullopt;
  return *found;
}

void PairingCodes::drop_for_owner() {
  std::erase_if(codes_, [](const PairingCode& c) { return c.makes_owner; });
}

void PairingCodes::drop_expired(SteadyTime now) {
  std::erase_if(codes_, [&](const PairingCode& c) { return now >= c.expires; });
}

}  // namespace dynslam
