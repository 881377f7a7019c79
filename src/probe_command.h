// SPDX-License-Identifier: MIT
#pragma once

#include <iosfwd>

#include "config.h"

namespace dynslam {

struct ProbeOptions {
  bool spin_motors = false;  ///< turns both wheels a little, after a person said yes
};

/// Talks to each device that the configuration names and tells what it says, in words for people, and for
/// what does not answer what to look at. Returns the exit code: 1 when a device does not answer, and 128 and
/// its number after a signal. Not while
/// `run` has the devices.
int run_probe(const ProbeOptions& options, const Config& config, std::istream& in, std::ostream& out);

}  // namespace dynslam
