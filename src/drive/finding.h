// SPDX-License-Identifier: MIT
#pragma once

#include "base/cause.h"
#include "base/verdict.h"

namespace dynslam {

/// What one row of Safety's table says: how bad it is, and why in words.
struct Finding {
  Cause cause = Cause::kNone;
  Verdict verdict{Motion::kGo, {}};
};

}  // namespace dynslam
