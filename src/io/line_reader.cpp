// SPDX-License-Identifier: MIT
#include "io/line_reader.h"

#include <algorithm>
#include <cstring>

namespace dynslam {
namespace {

constexpr std::size_t kBlock = 64 << 10;

}  // namespace

LineReader::LineReader(ByteSource& source) : text_(source), buffer_(2 * kBlock, '\0') {}

std::optional<Line> LineReader::next() {
  std::size_t searched = 0;
  while (true) {
    const char* from = buffer_.data() + begin_ + searched;
    const void* newline = std::memchr(from, '\n', end_ - begin_ - searched);
    if (newline != nullptr) return take(static_cast<const char*>(newline) - buffer_.data() - begin_, true);
    searched = end_ - begin_;
    if (searched > kMaxLine) {
      ++line_number_;
      return Line{{}, skip_to_newline(), true};
    }
    if (!read_more()) break;
  }
  if (begin_ == end_) return std::nullopt;
  return take(end_ - begin_, false);
}

std::string_view LineReader::peek() {
  while (end_ - begin_ < kBlock && read_more()) {
  }
  return std::string_view(buffer_).substr(begin_, std::min(end_ - begin_, kBlock));
}

/// Moves what is left to the front and reads behind it; the buffer doubles when a line fills it.
bool LineReader::read_more() {
  if (begin_ > 0 && buffer_.size() - end_ < kBlock) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
  }
  if (buffer_.size() - end_ < kBlock) buffer_.resize(2 * buffer_.size());
  const std::size_t got = text_.read(buffer_.data() + end_, kBlock);
  end_ += got;
  return got > 0;
}

bool LineReader::skip_to_newline() {
  do {
    begin_ = end_ = 0;
    if (!read_more()) return false;
    const void* newline = std::memchr(buffer_.data(), '\n', end_);
    if (newline != nullptr) {
      begin_ = static_cast<const char*>(newline) - buffer_.data() + 1;
      return true;
    }
  } while (true);
}

Line LineReader::take(std::size_t length, bool has_newline) {
  std::string_view text = std::string_view(buffer_).substr(begin_, length);
  begin_ += length + (has_newline ? 1 : 0);
  ++line_number_;
  if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
  return {text, has_newline};
}

}  // namespace dynslam
