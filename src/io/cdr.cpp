// SPDX-License-Identifier: MIT
#include "io/cdr.h"

namespace dynslam {

CdrReader::CdrReader(Bytes message) : cursor_(message) {
  const Bytes header = cursor_.take(CdrWriter::kHeader);
  if (header.empty()) return;
  // Only plain CDR; parameter lists and the second version (other alignment) are not what ROS 2 writes by
  // default.
  if (header[0] != 0 || header[1] > 1) cursor_.fail();
  order_ = header[1] == 0 ? std::endian::big : std::endian::little;
}

void CdrReader::align(std::size_t size) {
  const std::size_t over = (cursor_.position() - CdrWriter::kHeader) % size;
  if (ok() && over != 0) cursor_.take(size - over);
}

std::string_view CdrReader::text() {
  const Bytes taken = cursor_.take(number<std::uint32_t>());
  const std::string_view text(reinterpret_cast<const char*>(taken.data()), taken.size());
  return text.substr(0, text.find('\0'));
}

std::vector<float> CdrReader::floats(std::size_t most) {
  const auto count = number<std::uint32_t>();
  if (count > most) cursor_.fail();
  const Bytes taken = cursor_.take(std::uint64_t{count} * sizeof(float));
  std::vector<float> values(taken.size() / sizeof(float));
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = load<float>(taken.data() + i * sizeof(float), order_);
  return values;
}

CdrWriter::CdrWriter(std::endian order) : order_(order) {
  out_.number(std::uint8_t{0}).number(static_cast<std::uint8_t>(order == std::endian::big ? 0 : 1));
  out_.number(std::uint16_t{0});
}

CdrWriter& CdrWriter::text(std::string_view text) {
  put(static_cast<std::uint32_t>(text.size() + 1));
  out_.raw(text).number(std::uint8_t{0});
  return *this;
}

CdrWriter& CdrWriter::floats(std::span<const float> values) {
  put(static_cast<std::uint32_t>(values.size()));
  for (const float value : values) out_.number(value, order_);
  return *this;
}

CdrWriter& CdrWriter::blob(std::string_view bytes) {
  put(static_cast<std::uint32_t>(bytes.size()));
  out_.raw(bytes);
  return *this;
}

}  // namespace dynslam
