// SPDX-License-Identifier: MIT
#pragma once

#include "base/twist.h"
#include "drive/body_config.h"

namespace dynslam {

/// By how much the body is grown before it is moved, so that it does not pass too close. More than zero.
struct BodyMargin {
  double leading_m = 0.1;  ///< in the direction of motion
  double side_m = 0.03;    ///< on the other sides
};

/// What the grown body sweeps while the robot drives with a constant twist, along an arc, straight or turning
/// on the spot. A point that already is within the margin counts only when the motion brings it nearer: the
/// margin shrinks to just exclude it.
class Sweep {
 public:
  /// REQUIRES: a finite twist that moves.
  Sweep(const BodyConfig& body, const BodyMargin& margin, const Twist& twist);

  /// Seconds until the body touches a point that stands at (x, y) in the robot's frame; infinite when it
  /// never does.
  double contact_s(double x_m, double y_m) const;

 private:
  struct Box {
    double front, rear, side;  ///< distances from the middle of the axle
  };
  Box box_excluding(double x, double y) const;
  double contact_straight(const Box& box, double x, double y) const;
  double contact_on_arc(const Box& box, double x, double y) const;

  double half_length_, half_width_, leading_, trailing_, side_;
  double v_, w_;  ///< mirrored such that neither is negative
  double flip_x_, flip_y_;
  bool straight_;
  double centre_y_ = 0;  ///< of the arc, on the y axis
};

}  // namespace dynslam
