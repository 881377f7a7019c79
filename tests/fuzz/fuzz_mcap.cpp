// SPDX-License-Identifier: MIT
#include "io/mcap_stream.h"
#include "tests/fuzz/read_any.h"

// The magic bytes are given, so that the fuzzer need not guess them.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string bytes(dynslam::kMcapMagic);
  bytes.append(reinterpret_cast<const char*>(data), size);
  dynslam::test::read_any(std::move(bytes));
  return 0;
}
