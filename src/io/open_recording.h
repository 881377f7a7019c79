// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "io/byte_source.h"
#include "io/recording.h"

namespace dynslam {

/// Like open_recording() for a file, from any bytes. Throws InputError, which begins with the source's name.
std::unique_ptr<Recording> open_recording(std::unique_ptr<ByteSource> source,
                                          const RecordingConfig& config = {});

}  // namespace dynslam
