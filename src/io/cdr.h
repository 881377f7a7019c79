// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>
#include <string_view>
#include <vector>

#include "io/byte_cursor.h"

namespace dynslam {

/// Reads a message in the Common Data Representation, as ROS 2 writes it: a header of four bytes that says
/// the byte order, then the fields, each aligned to its size counted from behind the header. What is missing
/// reads as zero or empty, and ok() turns false for good.
class CdrReader {
 public:
  explicit CdrReader(Bytes message);

  bool ok() const { return cursor_.ok(); }

  template <class T>
  T number() {
    align(sizeof(T));
    return cursor_.number<T>(order_);
  }

  /// Points into the message; without the closing zero.
  std::string_view text();

  /// Fails, without taking memory, if the count is over `most` or more than the message can hold.
  std::vector<float> floats(std::size_t most);

 private:
  void align(std::size_t size);

  ByteCursor cursor_;
  std::endian order_ = std::endian::little;
};

}  // namespace dynslam
