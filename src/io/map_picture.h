// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "base/pose2.h"
#include "grid/trinary_map.h"

namespace dynslam {

/// What is drawn over the cells of a map picture. Empty layers are left out.
struct MapPictureLayers {
  std::vector<Vector2>
      path_map;  ///< where the robot was, in order; metres, map frame; non-finite points are left out
  std::vector<Vector2> route_map = {};   ///< where it is to drive: way-points, the last one the destination
  std::vector<Vector2> places_map = {};  ///< what it wants to see
};

/// The map as a person looks at it: a PNG picture with dark walls, pale floor, blue-grey where nothing is
/// known, the path from its start (green ring) to its end (red disc), the route ahead (green, a dot each
/// way-point), places to see (orange), a scale bar, y up.
///
/// Cropped to the known cells. A cell becomes a square of whole pixels, or several a pixel, so that the long
/// side has about 800 to 2400 pixels; a pixel that holds any occupied cell is dark, so walls never get lost.
/// The same map and layers give the same bytes. Besides the result it takes about a megabyte, however large
/// the map is.
std::string to_png(const TrinaryMap& map, const MapPictureLayers& layers = {});

}  // namespace dynslam
