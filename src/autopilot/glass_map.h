// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "base/time.h"
#include "drive/segment.h"

namespace dynslam {

/// Panes of glass, as they were met squarely. The map forgets them, as other beams go through: they are kept
/// out of as areas are that people drew. In the map's frame as it was then. One thread.
class GlassMap {
 public:
  /// Panes that are seen now, from a robot that is at a place and therefore not in one. Returns whether
  /// anything changed worth planning anew.
  bool see(Time now, std::span<const Segment> panes_map, const Vector2& robot_map);
  /// They shut the way, and may be open by now: each counts for nothing until it is seen again, or trust().
  /// They are doubted once, and not again before trust(). Returns whether that changes anything.
  bool doubt();
  /// What was doubted counts again. Returns whether that changes anything.
  bool trust();

  /// Thin outlines in the map.
  std::vector<std::vector<Vector2>> outlines_map() const;

 private:
  struct Pane {
    Segment at_map;
    Time seen;
    bool is_doubted = false;
  };
  std::vector<Pane> panes_;
  bool doubts_ = false;  ///< since trust()
};

}  // namespace dynslam
