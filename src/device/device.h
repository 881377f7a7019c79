// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "base/counters.h"

namespace dynslam {

/// What all devices can tell of themselves. Asked by the thread that uses the device; neither talks to it.
class Device {
 public:
  virtual ~Device() = default;
  /// What it is and how it is set, in a line for people; empty while that is not known.
  virtual std::string about() const { return {}; }
  /// What went wrong and was got over, ever, by name.
  virtual Counters counters() const { return {}; }
};

}  // namespace dynslam
