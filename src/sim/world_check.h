// SPDX-License-Identifier: MIT
#pragma once

#include "sim/toml_fields.h"
#include "sim/world.h"

namespace dynslam {

/// Whether the parts of a world fit together: walls that cross, doors that sit in no opening, people and
/// tours that go through things, a start inside of something. What does not fit is added to `problems`. Start
/// and tour are left out where the file gave no start.
void check_world(const World& world, Problems& problems);

}  // namespace dynslam
