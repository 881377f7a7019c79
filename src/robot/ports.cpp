// SPDX-License-Identifier: MIT
#include "robot/ports.h"

namespace dynslam {

Counters Ports::counters() const {
  Counters all;
  for (const auto* part : {&slam_counters, &graph_counters, &drive_counters}) {
    const auto counted = part->get().value;
    if (!counted) continue;
    for (const auto& [name, n] : *counted) all.add(name, n);
  }
  for (const auto& [device, health] : device_healths()) {
    const auto known = health->get().value;
    if (!known) continue;
    for (const auto& [name, n] : known->counters) all.add(std::string(device) + '.' + name, n);
  }
  return all;
}

}  // namespace dynslam
