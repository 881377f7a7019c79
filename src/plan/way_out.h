// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "plan/ground.h"

namespace dynslam {

/// How far it may be from where the robot stands to where it has room: farther in a no-go area, which people
/// may draw around it.
double way_out_reach_m(const Costmap& map, const Vector2& start_map);

/// From the start to the nearest place from which the search can go on: only the start where it has room;
/// else points along cells, rather where there is more room, never through what the map has occupied (but out
/// of it, where the start itself shows as occupied), across unknown ground if need be, and across no-go areas
/// where the start lies in one.
/// Nothing when there is no such place within way_out_reach_m(). REQUIRES: the map's box holds the start.
std::optional<std::vector<Vector2>> way_out(const Costmap& map, const Ground& ground,
                                            const Vector2& start_map);
/// As way_out(), to a place that leads on, which is asked of the indices of coarse cells, through gaps that
/// leave the robot half the room that it should have.
std::optional<std::vector<Vector2>> way_out_to(const std::function<bool(std::size_t)>& leads_on,
                                               const Costmap& map, const Ground& ground,
                                               const Vector2& start_map);

}  // namespace dynslam
