// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "io/byte_sink.h"

namespace dynslam {

/// Another run writes to the folder.
struct FolderInUse : InputError {
  using InputError::InputError;
};

/// A folder that gets its results all together or not at all. Files are first written beside their final
/// names as
/// `.NAME.partial`; only commit() renames them, so that an older result stays whole whatever fails before.
/// Only one OutputFolder at a time may hold a folder, across processes too. One thread at a time.
///
/// It cannot make the renames one step: power lost in the middle of commit() may leave new files beside old
/// ones, each of them whole.
class OutputFolder {
 public:
  /// Creates the folder and its parents where missing and tries that files can be written, long before there
  /// are any. Throws InputError when not, FolderInUse when another run holds it. `file_mode` is who may read
  /// and write the files, less what the umask takes away.
  explicit OutputFolder(std::string path, unsigned file_mode = 0666);

  /// Removes what was staged and not committed.
  ~OutputFolder();

  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Writes a file under its temporary name and makes sure it is on the disk. `name` has no folder in it;
  /// staging a name again replaces it. Throws std::runtime_error when that fails (disk full); nothing of the
  /// file is left then.
  void stage(const std::string& name, std::string_view bytes);

  /// The same for what is too large to be held whole: `write` is called once and puts the bytes into the
  /// sink.
  void stage(const std::string& name, const std::function<void(const ByteSink&)>& write);

  /// Stages a file that is written elsewhere, bit by bit, and returns where: a path where nothing is. What is
  /// there at commit() gets the name; if nothing is, an older file of the name goes. Throws as stage() does.
  std::string reserve(const std::string& name);

  /// Gives every staged file its final name. Throws std::runtime_error.
  void commit();

  const std::string& path() const { return path_; }

 private:
  void open_and_lock();
  void try_writing();
  void discard(const std::string& name) noexcept;
  void refuse_folder(const std::string& name) const;
  std::string shown(const std::string& name) const;

  std::string path_;
  unsigned file_mode_;
  int folder_ = -1;
  std::vector<std::string> staged_, reserved_;
};

}  // namespace dynslam
