// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/wall_time.h"

namespace dynslam {

/// The folder that keeps recordings: those that somebody asked for, which stay, and a ring of numbered files
/// of which the oldest go. Errors are runtime_errors that name the folder. One thread at a time.
class RecordingFolder {
 public:
  explicit RecordingFolder(std::string path) : path_(std::move(path)) {}

  /// `recording-NAME.mcap`, or with a number behind the name where there is one already.
  std::string new_file(std::string_view name) const;

  /// The same by the date, later than all that have one in their names: so names sort as they were given,
  /// whatever the clock does.
  std::string new_dated_file(WallTime now) const;

  /// The next file of the ring.
  std::string next_in_ring() const;

  /// Deletes the ring's oldest files until the others have `most` bytes at most, and so many bytes of the
  /// disk are free; where that cannot be had, not for its sake.
  void shrink_ring(std::uint64_t most, std::uint64_t free_floor) const;

 private:
  std::string path_;
};

}  // namespace dynslam
