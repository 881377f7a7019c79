// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "base/pose2.h"
#include "base/time.h"

namespace dynslam {

/// What came of a try: there was no way, though the planner knew one; it was looked at through something that
/// was shut; it was looked at from near and did not change.
enum class InVain { kNoWay, kShut, kSeen };

/// Remembers where the robot tried in vain, and for how long to leave that alone. Places nearer than
/// `within_m` are the same; beyond `most_places` the one tried longest ago is forgotten. One thread.
class TriedPlaces {
 public:
  struct Tried {
    Vector2 point_map;
    int tries = 0;
    Time last;
    Time until;  ///< left alone
    InVain last_try = InVain::kNoWay;
  };

  explicit TriedPlaces(double within_m, std::size_t most_places = 256)
      : within_m_(within_m), most_places_(most_places) {}

  /// What is known of the place nearest to a point; null: nothing.
  const Tried* find(const Vector2& point_map) const;
  /// Another try, or the first one. Returns how many there were.
  int add(Time now, const Vector2& point_map, Duration leave_alone, InVain last_try = InVain::kNoWay);
  /// Leaves it alone for a time, and then all tries are to be had again.
  void rest(Time now, const Vector2& point_map, Duration leave_alone);

 private:
  Tried& entry(const Vector2& point_map);

  double within_m_;
  std::size_t most_places_;
  std::vector<Tried> places_;
};

}  // namespace dynslam
