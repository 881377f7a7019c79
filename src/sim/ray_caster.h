// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "sim/surface.h"

namespace dynslam {

/// A beam in the world: along `direction` (level, unit length), rising by `slope` for each metre of it.
struct SpaceRay {
  Vector2 from = Vector2::Zero();
  double height_m = 0.0;
  Vector2 direction = Vector2::UnitX();
  double slope = 0.0;
  double max_m = std::numeric_limits<double>::infinity();  ///< along `direction`
  double glass_cosine = 0.0;  ///< glass is seen when the cosine of incidence is over this; 0: always
};

struct RayHit {
  double distance_m = 0.0;           ///< along the level direction
  double cosine = 1.0;               ///< of the angle of incidence, in the plan
  const Surface* surface = nullptr;  ///< null: the floor
  bool enters = true;                ///< the part, rather than leaves it
};

/// Finds what beams meet first. Faces lie in a uniform grid of buckets; those that never move are sorted in
/// once and shared by copies, those that move as often as they do. What is horizontal, tops and undersides,
/// is not met: a beam that sinks into a thing from above meets its far side from within.
///
/// Const calls may run at once in many threads; set_moving is one thread's.
class RayCaster {
 public:
  /// REQUIRES: finite; the moving ones stay within `reach`, which is added to what the fixed ones span.
  RayCaster(const std::vector<Surface>& fixed, const std::vector<Vector2>& reach);

  void set_moving(std::vector<Surface> moving);
  const std::vector<Surface>& moving() const { return moving_; }

  std::optional<RayHit> cast(const SpaceRay& ray) const;
  /// All upright faces along a level ray, whatever their heights, nearest first, until one hides all that is
  /// behind it: from the floor to `full_height_m` or more. The floor is not among them.
  void cast_through(const SpaceRay& ray, double full_height_m, std::vector<RayHit>& hits) const;
  /// Whether any face for which `test(const Surface&)` holds lies in the buckets that a disc touches.
  template <class Test>
  bool any_near(const Vector2& middle, double radius_m, Test&& test) const;

  /// The same as cast, face by face: what it is tested against.
  std::optional<RayHit> cast_by_brute_force(const SpaceRay& ray) const;

  const Vector2& low_corner() const { return buckets_->low; }
  const Vector2& high_corner() const { return buckets_->high; }

 private:
  /// Fixed faces by bucket: those of bucket i are items[begin[i]] to items[begin[i + 1]].
  struct Buckets {
    Vector2 low = Vector2::Zero(), high = Vector2::Zero();
    double side_m = 0.25;
    int columns = 1, rows = 1;
    std::vector<std::uint32_t> begin;
    std::vector<Surface> items;

    int column_of(double x) const;
    int row_of(double y) const;
  };
  /// A moving face in a bucket, and the next one in the same.
  struct Link {
    std::uint32_t surface;
    std::int32_t next;
  };

  static std::shared_ptr<const Buckets> sorted_in(const std::vector<Surface>& fixed,
                                                  const std::vector<Vector2>& reach);
  template <class VisitBucket>
  static void for_each_bucket(const Buckets& buckets, const Surface& surface, VisitBucket&& visit);
  template <class VisitBucket>
  void walk(const SpaceRay& ray, VisitBucket&& visit) const;

  std::shared_ptr<const Buckets> buckets_;
  std::vector<Surface> moving_;
  std::vector<Link> links_;
  std::vector<std::int32_t> first_link_;  ///< by bucket, -1: none
  std::vector<std::uint32_t> used_;       ///< buckets that have links
};

template <class Test>
bool RayCaster::any_near(const Vector2& middle, double radius_m, Test&& test) const {
  const Buckets& b = *buckets_;
  for (int row = b.row_of(middle.y() - radius_m); row <= b.row_of(middle.y() + radius_m); ++row) {
    for (int column = b.column_of(middle.x() - radius_m); column <= b.column_of(middle.x() + radius_m);
         ++column) {
      const auto bucket = static_cast<std::size_t>(row) * b.columns + column;
      for (std::uint32_t i = b.begin[bucket]; i < b.begin[bucket + 1]; ++i) {
        if (test(b.items[i])) return true;
      }
      for (std::int32_t link = first_link_[bucket]; link >= 0; link = links_[link].next) {
        if (test(moving_[links_[link].surface])) return true;
      }
    }
  }
  return false;
}

}  // namespace dynslam
