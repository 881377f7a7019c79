// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace dynslam {

/// BLAKE2b of a secret. Secrets are 256 random bits, so nobody finds one by trying, and a fast hash hides
/// them as well as a slow one would; a password, which people choose, would need a slow one.
using Digest = std::array<unsigned char, 32>;

/// 256 bits, 43 letters of base64url. From the system's generator, as all that follows.
std::string new_secret();
/// Names a credential; no secret. 12 letters.
std::string new_id();
/// 8 letters (40 bits) that a person can read out and type: no I, L, O or U.
std::string new_code();

/// Whether the text can be a secret at all.
bool is_secret(std::string_view text);
/// The code that a person meant: lower case, spaces, dashes and look-alikes put right; nothing when it
/// cannot be one.
std::optional<std::string> typed_code(std::string_view text);

Digest digest_of(std::string_view secret);
/// In a time that says nothing about where they differ.
bool is_same(const Digest& a, const Digest& b);

std::string hex_of(const Digest& digest);
std::optional<Digest> digest_from_hex(std::string_view hex);

}  // namespace dynslam
