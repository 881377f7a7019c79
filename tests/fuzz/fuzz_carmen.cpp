// SPDX-License-Identifier: MIT
#include <cstdint>

#include "tests/fuzz/read_any.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  dynslam::test::read_any(std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}
