// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "io/text_stream.h"

namespace dynslam {

struct Line {
  std::string_view text;    ///< without its end; valid until the next call of the reader
  bool has_newline = true;  ///< false for a last line that may have been cut off
  bool too_long = false;    ///< it was skipped, text is empty
};

/// Cuts a text into lines. Memory grows with the longest line, up to `kMaxLine`.
class LineReader {
 public:
  static constexpr std::size_t kMaxLine = 32 << 20;  ///< characters; a million beams need about 8 million

  /// Keeps a reference to `source`.
  explicit LineReader(ByteSource& source);

  /// The next line; nothing at the end.
  std::optional<Line> next();

  /// The first characters of what is still to come, at most 64 KiB; nothing is consumed.
  std::string_view peek();

  /// How many lines next() has returned: the number of the last one, counted from 1.
  std::uint64_t line_number() const { return line_number_; }

  /// Why the text broke off, see TextStream::fault().
  const std::string& fault() const { return text_.fault(); }

 private:
  bool read_more();
  bool skip_to_newline();
  Line take(std::size_t length, bool has_newline);

  TextStream text_;
  std::string buffer_;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::uint64_t line_number_ = 0;
};

}  // namespace dynslam
