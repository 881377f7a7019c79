// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

struct aiocb;

namespace dynslam {

/// A file that grows at its end. What was appended survives the process at once, and the power a few seconds
/// later. Errors are runtime_errors, one line that names the file. One thread at a time.
class RecordingFile {
 public:
  /// Creates it, and the folders above where missing; a file that is there is never touched. So many bytes
  /// of the disk stay free.
  RecordingFile(std::string path, std::uint64_t free_floor);
  ~RecordingFile();
  RecordingFile(const RecordingFile&) = delete;
  RecordingFile& operator=(const RecordingFile&) = delete;

  /// All of the bytes, or none where it throws: the disk is full or down to the floor, or does not write.
  void append(std::string_view bytes);
  /// From now on the floor does not count: there is only the end of the file to come.
  void use_floor() { free_floor_ = 0; }

  /// Has what was appended put on the disk, in the background, unless that is still under way.
  void sync_soon();
  bool syncing() const;
  /// The same now, and waits for it.
  void sync();

  /// Takes it off the disk.
  void remove() noexcept;

  const std::string& path() const { return path_; }
  std::uint64_t size() const { return size_; }

 private:
  void keep_floor(std::uint64_t bytes) const;
  void cut_back() noexcept;
  void settle();
  void check_sync() const;
  [[noreturn]] void fail(int error) const;

  std::string path_;
  std::uint64_t free_floor_;
  int file_ = -1;
  std::uint64_t size_ = 0;
  std::unique_ptr<aiocb> sync_;  ///< null: none was asked for
  int sync_error_ = 0;           ///< of one that failed
};

}  // namespace dynslam
