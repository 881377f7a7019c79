// SPDX-License-Identifier: MIT
#include "io/recording_folder.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <vector>

namespace dynslam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDated = "recording-";
constexpr std::string_view kPrefix = "ring-", kSuffix = ".mcap";
constexpr std::size_t kDigits = 8;

struct RingFile {
  std::uint64_t number = 0;
  std::uint64_t size = 0;
  fs::path path;
};

std::string ring_name(std::uint64_t number) {
  const std::string digits = std::to_string(number);
  const std::size_t missing = digits.size() < kDigits ? kDigits - digits.size() : 0;
  return std::string(kPrefix) + std::string(missing, '0') + digits + std::string(kSuffix);
}

/// Only what next_in_ring() would call so.
std::optional<std::uint64_t> ring_number(const std::string& name) {
  if (!name.starts_with(kPrefix) || !name.ends_with(kSuffix)) return std::nullopt;
  std::uint64_t number = 0;
  std::from_chars(name.data() + kPrefix.size(), name.data() + name.size() - kSuffix.size(), number);
  return ring_name(number) == name ? std::optional(number) : std::nullopt;
}

/// Oldest first. Empty for a folder that is not there.
std::vector<RingFile> ring_files(const std::string& folder) {
  std::vector<RingFile> files;
  std::error_code error;
  for (auto it = fs::directory_iterator(folder, error); !error && it != fs::directory_iterator();
       it.increment(error)) {
    std::error_code gone;
    const auto number = ring_number(it->path().filename().string());
    if (!number || !it->is_regular_file(gone) || it->is_symlink(gone)) continue;
    const std::uintmax_t size = it->file_size(gone);
    files.push_back({*number, gone ? 0 : size, it->path()});
  }
  if (error && error != std::errc::no_such_file_or_directory)
    throw std::runtime_error("cannot read " + folder + ": " + error.message());
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return a.number < b.number; });
  return files;
}

}  // namespace

std::string RecordingFolder::new_file(std::string_view name) const {
  const std::string stem = kDated + std::string(name);
  fs::path path = fs::path(path_) / (stem + std::string(kSuffix));
  for (int i = 2; fs::exists(path); ++i)
    path = fs::path(path_) / (stem + '-' + std::to_string(i) + std::string(kSuffix));
  return path.string();
}

std::string RecordingFolder::new_dated_file(WallTime now) const {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(path_, error), end; !error && it != end; it.increment(error))
    if (const std::string name = it->path().filename(); name.starts_with(kDated)) names.push_back(name);
  return new_file(utc_text(time_after(names, now)));
}

std::string RecordingFolder::next_in_ring() const {
  const std::vector<RingFile> files = ring_files(path_);
  return (fs::path(path_) / ring_name(files.empty() ? 1 : files.back().number + 1)).string();
}

void RecordingFolder::shrink_ring(std::uint64_t most, std::uint64_t free_floor) const {
  const std::vector<RingFile> files = ring_files(path_);
  std::uint64_t sum = std::accumulate(files.begin(), files.end(), std::uint64_t{0},
                                      [](std::uint64_t s, const RingFile& f) { return s + f.size; });
  std::error_code unknown;
  const std::uintmax_t free = fs::space(path_, unknown).available;
  const bool can_help = !unknown && free + sum >= free_floor;
  for (const RingFile& file : files) {
    std::error_code error;
    const fs::space_info disk = fs::space(path_, error);
    const bool is_tight = can_help && !error && disk.available < free_floor;
    if (sum <= most && !is_tight) return;
    if (!fs::remove(file.path, error) && error)
      throw std::runtime_error("cannot delete " + file.path.string() + ": " + error.message());
    sum -= file.size;
  }
}

}  // namespace dynslam
