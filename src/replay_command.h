// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "config.h"

namespace dynslam {

struct ReplayOptions {
  std::string recording;
  std::string out = "out";
  bool quiet = false;
  std::uint64_t frames = 0;  ///< a picture after every so many scans; 0: none
};

/// `dynslam replay`: a recording in; trajectory, map, picture and report out. Returns the exit code: 0, or 2
/// when the recording broke off and only what came before was mapped. Throws InputError for what cannot be
/// used, and then leaves an older result as it was.
int run_replay(const ReplayOptions& options, const Config& config);

}  // namespace dynslam
