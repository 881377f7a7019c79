// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "base/counters.h"
#include "robot/ports.h"
#include "server/delay_histogram.h"

namespace dynslam {

/// What the server itself has to tell.
struct ServerFigures {
  Counters counters;
  std::size_t connections = 0;
  DelayHistogram command_to_motor, drop_to_off;
};

/// All in the text format that Prometheus reads, version 0.0.4.
std::string metrics_text(const Ports& ports, const ServerFigures& figures);

}  // namespace dynslam
