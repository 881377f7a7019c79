// SPDX-License-Identifier: MIT
#pragma once

namespace dynslam {

enum class BatteryLevel { kUnknown, kGood, kLow, kRecharge };

/// The battery as it is shown: its level is averaged, as the voltage dips with every start; a brownout is
/// told at once (thesis, 3.4).
struct BatteryState {
  double voltage_v = 0.0;  ///< averaged; 0 when nothing was measured yet
  double share = 0.0;      ///< of what it holds, 0 to 1
  BatteryLevel level = BatteryLevel::kUnknown;
  bool brownout = false;  ///< the voltage fell below what the computer needs, a short time ago
};

}  // namespace dynslam
