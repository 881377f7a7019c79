// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "io/byte_source.h"

struct z_stream_s;

namespace dynslam {

/// The text of a source, unpacked if it begins like gzip. Several gzip members in a row are one text.
/// Memory: two buffers of 64 KiB, whatever the source holds.
class TextStream {
 public:
  /// Keeps a reference to `source`.
  explicit TextStream(ByteSource& source);
  ~TextStream();

  /// Reads up to `size` characters; 0 only at the end, or where the source stops making sense (see fault()).
  std::size_t read(char* to, std::size_t size);

  /// Why the text broke off, with the byte offset in the source; empty when it did not.
  const std::string& fault() const { return fault_; }

 private:
  struct EndInflate {
    void operator()(z_stream_s* stream) const;
  };

  bool refill();
  std::size_t read_plain(char* to, std::size_t size);
  std::size_t read_gzip(char* to, std::size_t size);
  bool begin_next_member();
  void fail(const std::string& why);

  ByteSource& source_;
  std::vector<unsigned char> packed_;
  std::size_t packed_begin_ = 0;
  std::size_t packed_end_ = 0;
  std::unique_ptr<z_stream_s, EndInflate> inflate_;  ///< null: the text is plain
  bool in_member_ = false;
  bool ended_ = false;
  std::string fault_;
};

}  // namespace dynslam
