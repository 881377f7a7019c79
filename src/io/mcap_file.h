// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "io/recording_file.h"
#include "io/ros_writer.h"

namespace dynslam {

/// A recording that is being written: messages gather in a chunk, chunks go into the file. Whenever it is
/// left alone the file is good up to its last chunk. One thread at a time.
class McapFile {
 public:
  /// Creates the file. `library` and `about` are what it says of the program and its settings. Throws
  /// runtime_error, as the calls below do, when the file cannot be written; see RecordingFile.
  McapFile(std::string path, std::uint64_t free_floor, const std::string& library,
           const McapWriter::Metadata& about);

  RosWriter& ros() { return ros_; }
  /// Bytes that wait for close_chunk().
  std::size_t waiting() const { return mcap_.waiting(); }
  void close_chunk() { mcap_.close_chunk(); }

  /// Writes what waits and the end of the file, as far as there is room: what does not fit is left out, and
  /// never half written. Returns why something was, empty when nothing was.
  std::string finish();

  RecordingFile& file() { return file_; }
  const RecordingFile& file() const { return file_; }
  std::uint64_t messages() const { return mcap_.messages(); }

 private:
  RecordingFile file_;
  McapWriter mcap_;
  RosWriter ros_;
};

}  // namespace dynslam
