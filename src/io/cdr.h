// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/byte_cursor.h"
#include "io/byte_writer.h"

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

/// Writes such a message, field by field.
class CdrWriter {
 public:
  static constexpr std::size_t kHeader = 4;

  explicit CdrWriter(std::endian order = std::endian::little);

  template <class T>
  CdrWriter& put(T value) {
    while ((out_.size() - kHeader) % sizeof(T) != 0) out_.number(std::uint8_t{0});
    out_.number(value, order_);
    return *this;
  }
  template <class T>
  CdrWriter& put_all(std::initializer_list<T> values) {
    for (const T& value : values) put(value);
    return *this;
  }
  CdrWriter& text(std::string_view text);
  /// A sequence: the count and the values.
  CdrWriter& floats(std::span<const float> values);
  /// A sequence of bytes.
  CdrWriter& blob(std::string_view bytes);

  const std::string& bytes() const { return out_.bytes(); }

 private:
  std::endian order_;
  ByteWriter out_;
};

}  // namespace dynslam
