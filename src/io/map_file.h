// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "grid/trinary_map.h"
#include "io/byte_sink.h"

namespace dynslam {

/// The map as a binary PGM picture for the ROS map_server: 254 free, 205 unknown, 0 occupied; the top row of
/// the picture is the highest y. A map without cells becomes one unknown pixel. Goes out row by row, so that
/// the picture is never whole in memory; throws only what `out` throws.
void write_pgm(const TrinaryMap& map, const ByteSink& out);

/// The same as one string.
std::string to_pgm(const TrinaryMap& map);

/// What the ROS map_server reads beside the picture: metres a pixel and the pose of the picture's lower left
/// corner in the map frame. `image_name` is relative to where the text is stored.
std::string to_map_yaml(const TrinaryMap& map, const std::string& image_name);

}  // namespace dynslam
