// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "io/safe_file.h"

namespace dynslam {

/// A file in a folder that this program alone holds as long as this lives. It is always whole, and only its
/// owner may read it. One thread at a time.
class StateFile {
 public:
  static constexpr std::size_t kLongest = 1 << 20;

  /// Throws InputError when the folder cannot be written to, or another program holds it.
  explicit StateFile(const std::string& folder, std::string name = "access.json");

  /// Nothing when there is none. Throws InputError when it cannot be read.
  std::optional<std::string> read() const;
  /// Throws std::runtime_error, and then the older one is still there.
  void write(std::string_view text);

  const std::string& path() const { return path_; }

 private:
  OutputFolder folder_;
  std::string name_, path_;
};

}  // namespace dynslam
