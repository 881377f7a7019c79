// SPDX-License-Identifier: MIT
#include "io/cdr.h"

namespace dynslam {
namespace {

constexpr std::size_t kHeader = 4;

}  // namespace

CdrReader::CdrReader(Bytes message) : cursor_(message) {
  const Bytes header = cursor_.take(kHeader);
  if (header.empty()) return;
  // Only plain CDR; parameter lists and the second version (other alignment) are not what ROS 2 writes by
  // default.
  if (header[0] != 0 || header[1] > 1) cursor_.fail();
  order_ = header[1] == 0 ? std::endian::big : std::endian::little;
}

void CdrReader::align(std::size_t size) {
  const std::size_t over = (cursor_.position() - kHeader) % size;
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

}  // namespace dynslam
