// SPDX-License-Identifier: MIT
#include "sim/fault.h"

#include <algorithm>

namespace dynslam {
namespace {

template <class Enum, std::size_t N>
std::optional<Enum> find_name(const std::array<std::string_view, N>& names, std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<Enum>(found - names.begin());
}

}  // namespace

std::optional<SimDevice> sim_device_of(std::string_view name) {
  return find_name<SimDevice>(kSimDeviceNames, name);
}

std::optional<FaultKind> fault_kind_of(std::string_view name) {
  return find_name<FaultKind>(kFaultNames, name);
}

bool can_have(SimDevice device, FaultKind kind) {
  const bool has_sides = device == SimDevice::kLidar || device == SimDevice::kImu;
  const bool has_numbers = has_sides || device == SimDevice::kMotors;
  if (kind == FaultKind::kMirrored) return has_sides;
  if (kind == FaultKind::kNan || kind == FaultKind::kInfinite) return has_numbers;
  return true;
}

}  // namespace dynslam
