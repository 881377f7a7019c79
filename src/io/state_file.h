// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "io/safe_file.h"

namespace dynslam {

/// A file that outlasts the program, in a folder that this program alone holds as long as this lives. It is
/// always whole, and only its owner may read it. A disk that is full, broken or read-only stops nobody: then
/// there is a trouble, and each write tries anew. One thread at a time.
class StateFile {
 public:
  static constexpr std::size_t kLongest = 1 << 20;

  /// Throws FolderInUse when another program holds the folder.
  StateFile(std::string folder, std::string name);

  /// Gives `take` what was written last, if anything was. What cannot be read, or makes `take` throw
  /// InputError, is set aside as NAME.damaged, or with a number behind that. Returns what people should know
  /// of it, one sentence; empty when all is well.
  std::string load(const std::function<void(const std::string&)>& take);

  /// Gives the file another name in its folder, that of nothing else; nothing is written before that could
  /// be done. Returns whether it is done already.
  bool set_aside(const std::string& other_name);
  /// `stem` + `end`, or with a number between them where there is one already.
  std::string free_name(const std::string& stem, const std::string& end) const;

  /// Throws std::runtime_error, and then the older one is still there.
  void write(std::string_view text);

  /// Why it could not be written, the last time that was tried; one line, empty when it could.
  const std::string& trouble() const { return trouble_; }
  const std::string& path() const { return path_; }

 private:
  std::optional<std::string> read() const;
  void move_away();

  std::string folder_path_, name_, path_;
  std::optional<OutputFolder> folder_;
  std::string away_;  ///< what it is to be called before anything is written; empty: it is not in the way
  std::string trouble_;
};

}  // namespace dynslam
