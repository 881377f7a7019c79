// SPDX-License-Identifier: MIT
#include "drivers/bno055/calibration_profile.h"

#include <charconv>
#include <cstdlib>

namespace dynslam::bno055 {
namespace {

constexpr std::string_view kBegin = "bno055 1 ";
constexpr std::string_view kHex = "0123456789abcdef";
constexpr std::size_t kLength = kBegin.size() + 2 * std::tuple_size_v<Profile> + 1 + 8;

/// FNV-1a.
std::uint32_t checksum(const Profile& profile) {
  std::uint32_t sum = 2166136261U;
  for (const std::uint8_t byte : profile) sum = (sum ^ byte) * 16777619U;
  return sum;
}

void append_hex(std::string& text, unsigned byte) {
  text += kHex[byte >> 4 & 15];
  text += kHex[byte & 15];
}

/// `text` must be nothing but hexadecimal digits.
template <class Number>
bool read_hex(std::string_view text, Number& number) {
  const auto [end, error] = std::from_chars(text.begin(), text.end(), number, 16);
  return error == std::errc() && end == text.end();
}

}  // namespace

bool is_possible(const Profile& profile) {
  const auto within = [&](std::size_t number, int most) {
    const auto value = static_cast<std::int16_t>(profile[2 * number] | profile[2 * number + 1] << 8);
    return std::abs(int{value}) <= most;
  };
  // In steps of 1 mg within the 4 g of fusion, of 1/16 uT, and of 1/16 degree/s.
  constexpr int kAccelerometer = 4000, kMagnetometer = 6400, kGyroscope = 32000;
  constexpr int kAccelerometerRadius = 2048, kMagnetometerRadius = 1280;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!within(axis, kAccelerometer) || !within(3 + axis, kMagnetometer) || !within(6 + axis, kGyroscope))
      return false;
  }
  return within(9, kAccelerometerRadius) && within(10, kMagnetometerRadius);
}

std::string profile_text(const Profile& profile) {
  std::string text(kBegin);
  for (const std::uint8_t byte : profile) append_hex(text, byte);
  text += ' ';
  for (const int shift : {24, 16, 8, 0}) append_hex(text, checksum(profile) >> shift & 0xff);
  return text + '\n';
}

std::optional<Profile> read_profile(std::string_view text) {
  if (text.ends_with('\n')) text.remove_suffix(1);
  if (text.size() != kLength || !text.starts_with(kBegin)) return std::nullopt;
  Profile profile;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    if (!read_hex(text.substr(kBegin.size() + 2 * i, 2), profile[i])) return std::nullopt;
  }
  std::uint32_t sum = 0;
  if (text[kLength - 9] != ' ' || !read_hex(text.substr(kLength - 8), sum)) return std::nullopt;
  if (sum != checksum(profile) || !is_possible(profile)) return std::nullopt;
  return profile;
}

}  // namespace dynslam::bno055
