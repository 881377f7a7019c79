// SPDX-License-Identifier: MIT
#include "drive/sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angles.h"

namespace dynslam {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
/// An arc with a radius over this many metres is straight: within 3 m it is off by 5 mm.
constexpr double kStraightRadius_m = 1000.0;
/// Of the margin: how far outside a box a point is that lies on its edge.
constexpr double kOutside = 0.01;
/// The box never shrinks to less than this about the middle.
constexpr double kLeastHalf_m = 0.01;

/// The share of the way to the full margin at which an edge of the box passes through the point; negative
/// inside the body.
double level(double beyond_body_m, double margin_m) { return beyond_body_m / margin_m; }

}  // namespace

Sweep::Sweep(const BodyConfig& body, const BodyMargin& margin, const Twist& twist)
    : half_length_(body.half_length_m()), half_width_(body.half_width_m()), side_(margin.side_m) {
  // Mirrored in x, both v and w change their sign; mirrored in y, w alone.
  flip_x_ = twist.v_mps < 0.0 ? -1.0 : 1.0;
  v_ = std::abs(twist.v_mps);
  flip_y_ = flip_x_ * twist.w_radps < 0.0 ? -1.0 : 1.0;
  w_ = std::abs(twist.w_radps);
  straight_ = v_ > kStraightRadius_m * w_;
  if (!straight_) centre_y_ = v_ / w_;
  // From a turn on the spot to straight driving the leading margin grows to its own.
  const double forward_share = v_ / (v_ + w_ * body.radius_m());
  leading_ = margin.side_m + forward_share * (margin.leading_m - margin.side_m);
  trailing_ = margin.side_m;
}

Sweep::Box Sweep::box_excluding(double x, double y) const {
  const double out = std::max({level(x - half_length_, leading_), level(-x - half_length_, trailing_),
                               level(std::abs(y) - half_width_, side_)});
  const double share = std::min(1.0, out - kOutside);
  return {std::max(kLeastHalf_m, half_length_ + share * leading_),
          std::max(kLeastHalf_m, half_length_ + share * trailing_),
          std::max(kLeastHalf_m, half_width_ + share * side_)};
}

double Sweep::contact_s(double x_m, double y_m) const {
  const double x = flip_x_ * x_m, y = flip_y_ * y_m;
  const Box box = box_excluding(x, y);
  const bool inside = x < box.front && x > -box.rear && std::abs(y) < box.side;
  if (inside) return x > 0.0 || v_ == 0.0 ? 0.0 : kNever;
  return straight_ ? contact_straight(box, x, y) : contact_on_arc(box, x, y);
}

double Sweep::contact_straight(const Box& box, double x, double y) const {
  return std::abs(y) < box.side && x > 0.0 ? (x - box.front) / v_ : kNever;
}

/// Seen from the robot the point moves on a circle about the arc's centre, clockwise. Where that circle first
/// crosses an edge of the box, they touch.
double Sweep::contact_on_arc(const Box& box, double x, double y) const {
  const double up = y - centre_y_, radius = std::hypot(x, up);
  const double nearest_up = std::max(0.0, centre_y_ - box.side);
  const double farthest_up = centre_y_ + box.side;
  const double longer = std::max(box.front, box.rear);
  if (radius < nearest_up || radius > std::hypot(longer, farthest_up)) return kNever;

  const double now = std::atan2(up, x);
  double least_turn = kNever;
  const auto crosses_at = [&](double angle) {
    double turned = now - angle;
    if (turned < 0.0) turned += kTwoPi;
    least_turn = std::min(least_turn, turned);
  };
  for (const double edge : {box.front, -box.rear}) {
    if (std::abs(edge) >= radius) continue;
    const double half = std::sqrt(radius * radius - edge * edge);
    for (const double at : {half, -half}) {
      if (std::abs(at + centre_y_) <= box.side) crosses_at(std::atan2(at, edge));
    }
  }
  for (const double edge : {box.side - centre_y_, -box.side - centre_y_}) {
    if (std::abs(edge) >= radius) continue;
    const double half = std::sqrt(radius * radius - edge * edge);
    for (const double at : {half, -half}) {
      if (at <= box.front && at >= -box.rear) crosses_at(std::atan2(edge, at));
    }
  }
  return least_turn / w_;
}

}  // namespace dynslam
