// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>

#include "base/error.h"
#include "tests/io/read_all.h"

namespace dynslam::test {

/// Reads the bytes as a recording to the end, and aborts if it breaks a promise of Recording.
inline void read_any(std::string bytes) {
  try {
    const auto recording = open_recording(std::make_unique<MemorySource>(std::move(bytes)));
    while (const std::optional<Record> record = recording->next()) {
      if (!is_clean(*record)) std::abort();
    }
    if (recording->progress() != 1.0) std::abort();
  } catch (const InputError&) {
  }
}

}  // namespace dynslam::test
