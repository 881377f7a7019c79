// SPDX-License-Identifier: MIT
#include "autopilot/tried_places.h"

#include <algorithm>

namespace dynslam {

const TriedPlaces::Tried* TriedPlaces::find(const Vector2& point_map) const {
  const Tried* nearest = nullptr;
  double least_m = within_m_;
  for (const Tried& t : places_) {
    const double distance_m = (t.point_map - point_map).norm();
    if (distance_m >= least_m) continue;
    least_m = distance_m;
    nearest = &t;
  }
  return nearest;
}

TriedPlaces::Tried& TriedPlaces::entry(const Vector2& point_map) {
  if (const Tried* known = find(point_map)) return places_[static_cast<std::size_t>(known - places_.data())];
  if (places_.size() >= most_places_) {
    places_.erase(std::min_element(places_.begin(), places_.end(),
                                   [](const Tried& a, const Tried& b) { return a.last < b.last; }));
  }
  return places_.emplace_back(Tried{point_map, 0, Time(), Time(), InVain::kNoWay});
}

int TriedPlaces::add(Time now, const Vector2& point_map, Duration leave_alone, InVain last_try) {
  Tried& place = entry(point_map);
  place.last = now;
  place.until = now + leave_alone;
  place.last_try = last_try;
  return ++place.tries;
}

void TriedPlaces::rest(Time now, const Vector2& point_map, Duration leave_alone) {
  Tried& place = entry(point_map);
  place.last = now;
  place.until = now + leave_alone;
  place.tries = 0;
}

}  // namespace dynslam
