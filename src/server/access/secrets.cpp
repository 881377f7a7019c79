// SPDX-License-Identifier: MIT
#include "server/access/secrets.h"

#include <algorithm>
#include <cstdint>
#include <stdexcept>

#include <sodium.h>

namespace dynslam {
namespace {

constexpr std::size_t kSecretBytes = 32, kIdBytes = 9;
constexpr std::size_t kSecretLetters = 43;
constexpr std::size_t kCodeLetters = 8;
constexpr int kBase64 = sodium_base64_VARIANT_URLSAFE_NO_PADDING;
// Crockford's base 32.
constexpr std::string_view kLetters = "0123456789ABCDEFGHJKMNPQRSTVWXYZ";

void need_sodium() {
  static const int kReady = sodium_init();
  if (kReady < 0) throw std::runtime_error("no random numbers: libsodium does not start");
}

template <std::size_t Bytes>
std::string random_base64() {
  need_sodium();
  std::array<unsigned char, Bytes> bytes;
  randombytes_buf(bytes.data(), bytes.size());
  std::array<char, sodium_base64_ENCODED_LEN(Bytes, kBase64)> text;
  sodium_bin2base64(text.data(), text.size(), bytes.data(), bytes.size(), kBase64);
  return text.data();
}

constexpr bool is_base64url(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
}

/// The letter that was meant; '\0' when it is none.
constexpr char code_letter(char c) {
  if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  if (c == 'O') return '0';
  if (c == 'I' || c == 'L') return '1';
  return kLetters.find(c) == std::string_view::npos ? '\0' : c;
}

constexpr int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

}  // namespace

std::string new_secret() { return random_base64<kSecretBytes>(); }
std::string new_id() { return random_base64<kIdBytes>(); }

std::string new_code() {
  need_sodium();
  std::string code;
  for (std::size_t i = 0; i < kCodeLetters; ++i)
    code += kLetters[randombytes_uniform(static_cast<std::uint32_t>(kLetters.size()))];
  return code;
}

bool is_secret(std::string_view text) {
  return text.size() == kSecretLetters && std::all_of(text.begin(), text.end(), is_base64url);
}

std::optional<std::string> typed_code(std::string_view text) {
  constexpr std::size_t kLongest = 64;
  std::string code;
  for (const char c : text.substr(0, kLongest)) {
    if (c == '-' || c == ' ') continue;
    const char letter = code_letter(c);
    if (letter == '\0') return std::nullopt;
    code += letter;
  }
  if (text.size() > kLongest || code.size() != kCodeLetters) return std::nullopt;
  return code;
}

Digest digest_of(std::string_view secret) {
  need_sodium();
  Digest digest;
  crypto_generichash(digest.data(), digest.size(), reinterpret_cast<const unsigned char*>(secret.data()),
                     secret.size(), nullptr, 0);
  return digest;
}

bool is_same(const Digest& a, const Digest& b) { return sodium_memcmp(a.data(), b.data(), a.size()) == 0; }

std::string hex_of(const Digest& digest) {
  std::array<char, 2 * sizeof(Digest) + 1> text;
  return sodium_bin2hex(text.data(), text.size(), digest.data(), digest.size());
}

std::optional<Digest> digest_from_hex(std::string_view hex) {
  Digest digest;
  if (hex.size() != 2 * digest.size()) return std::nullopt;
  for (std::size_t i = 0; i < digest.size(); ++i) {
    const int high = hex_digit(hex[2 * i]), low = hex_digit(hex[2 * i + 1]);
    if (high < 0 || low < 0) return std::nullopt;
    digest[i] = static_cast<unsigned char>(high << 4 | low);
  }
  return digest;
}

}  // namespace dynslam
