// SPDX-License-Identifier: MIT
#include "sim/ray_caster.h"

#include <algorithm>
#include <cmath>

namespace dynslam {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kBucketSide_m = 0.25;
constexpr double kMostBuckets = 400000;
constexpr double kNearest_m = 1e-9;

/// Where a ray meets a face.
struct Meeting {
  double distance_m, cosine;
  bool enters;
};

/// Calls `visit(Meeting)` for each place where the level ray meets the face, nearest first: one for a
/// straight face, up to two for a cylinder.
template <class Visit>
void for_each_meeting(const SpaceRay& ray, const Surface& face, Visit&& visit) {
  const Vector2 off = face.from - ray.from;
  if (face.radius_m > 0) {
    const double along = off.dot(ray.direction), across = cross(off, ray.direction);
    const double half2 = face.radius_m * face.radius_m - across * across;
    if (half2 <= 0) return;
    const double half = std::sqrt(half2), cosine = half / face.radius_m;
    if (along - half > kNearest_m) visit(Meeting{along - half, cosine, true});
    if (along + half > kNearest_m) visit(Meeting{along + half, cosine, false});
    return;
  }
  const double turn = cross(ray.direction, face.along);
  if (std::abs(turn) < 1e-12) return;
  const double share = cross(off, ray.direction) / turn;
  if (share < 0 || share > 1) return;
  const double distance = cross(off, face.along) / turn;
  if (distance > kNearest_m) visit(Meeting{distance, std::abs(turn) / face.along.norm(), turn < 0});
}

/// Takes the face for the nearest so far, if the ray meets it sooner and at its height.
void keep_nearest(const SpaceRay& ray, const Surface& face, RayHit& nearest) {
  if (ray.slope == 0 && (ray.height_m < face.low_m || ray.height_m > face.high_m)) return;
  for_each_meeting(ray, face, [&](const Meeting& m) {
    if (m.distance_m >= nearest.distance_m) return;
    const double height = ray.height_m + ray.slope * m.distance_m;
    if (height < face.low_m || height > face.high_m) return;
    if (face.glass && m.cosine <= ray.glass_cosine) return;
    nearest = {m.distance_m, m.cosine, &face, m.enters};
  });
}

/// What the ray reaches where it meets nothing: the floor, or its length.
RayHit end_of(const SpaceRay& ray) {
  const double floor_m = ray.slope < 0 ? ray.height_m / -ray.slope : kNever;
  return {std::min(floor_m, ray.max_m), 1.0, nullptr, true};
}

std::optional<RayHit> found(const SpaceRay& ray, const RayHit& nearest) {
  const bool is_floor = ray.slope < 0 && nearest.distance_m < ray.max_m;
  if (nearest.surface == nullptr && !is_floor) return std::nullopt;
  return nearest;
}

}  // namespace

int RayCaster::Buckets::column_of(double x) const {
  return static_cast<int>(std::clamp((x - low.x()) / side_m, 0.0, columns - 1.0));
}

int RayCaster::Buckets::row_of(double y) const {
  return static_cast<int>(std::clamp((y - low.y()) / side_m, 0.0, rows - 1.0));
}

template <class VisitBucket>
void RayCaster::for_each_bucket(const Buckets& b, const Surface& face, VisitBucket&& visit) {
  const Vector2 to = face.from + face.along, half(b.side_m / 2, b.side_m / 2);
  const double r = face.radius_m + 1e-6;
  const bool is_round = face.radius_m > 0;
  const Vector2 low = is_round ? face.from : Vector2(face.from.cwiseMin(to));
  const Vector2 high = is_round ? face.from : Vector2(face.from.cwiseMax(to));
  for (int row = b.row_of(low.y() - r); row <= b.row_of(high.y() + r); ++row) {
    for (int column = b.column_of(low.x() - r); column <= b.column_of(high.x() + r); ++column) {
      const Vector2 middle = b.low + b.side_m * Vector2(column + 0.5, row + 0.5);
      // The face's line passes the bucket by when its distance is more than the bucket's extent across it.
      const double reach = (std::abs(face.along.x()) + std::abs(face.along.y())) * half.x() + 1e-6;
      if (!is_round && std::abs(cross(face.along, middle - face.from)) > reach) continue;
      visit(static_cast<std::size_t>(row) * b.columns + column);
    }
  }
}

std::shared_ptr<const RayCaster::Buckets> RayCaster::sorted_in(const std::vector<Surface>& fixed,
                                                               const std::vector<Vector2>& reach) {
  Buckets b;
  Vector2 low(kNever, kNever), high(-kNever, -kNever);
  const auto include = [&](const Vector2& p, double radius_m) {
    low = low.cwiseMin(Vector2(p.array() - radius_m));
    high = high.cwiseMax(Vector2(p.array() + radius_m));
  };
  for (const Surface& s : fixed) {
    include(s.from, s.radius_m);
    include(s.from + s.along, s.radius_m);
  }
  for (const Vector2& p : reach) include(p, 0.0);
  if (low.x() > high.x()) low = high = Vector2::Zero();
  b.low = low.array() - 0.01;
  b.high = high.array() + 0.01;
  const Vector2 span = b.high - b.low;
  b.side_m = std::max(kBucketSide_m, std::sqrt(span.x() * span.y() / kMostBuckets));
  b.columns = static_cast<int>(span.x() / b.side_m) + 1;
  b.rows = static_cast<int>(span.y() / b.side_m) + 1;
  b.begin.assign(static_cast<std::size_t>(b.columns) * b.rows + 1, 0);
  for (const Surface& s : fixed) for_each_bucket(b, s, [&](std::size_t i) { ++b.begin[i + 1]; });
  for (std::size_t i = 1; i < b.begin.size(); ++i) b.begin[i] += b.begin[i - 1];
  b.items.resize(b.begin.back());
  std::vector<std::uint32_t> next(b.begin.begin(), b.begin.end() - 1);
  for (const Surface& s : fixed) for_each_bucket(b, s, [&](std::size_t i) { b.items[next[i]++] = s; });
  return std::make_shared<const Buckets>(std::move(b));
}

RayCaster::RayCaster(const std::vector<Surface>& fixed, const std::vector<Vector2>& reach)
    : buckets_(sorted_in(fixed, reach)), first_link_(buckets_->begin.size() - 1, -1) {}

void RayCaster::set_moving(std::vector<Surface> moving) {
  for (const std::uint32_t bucket : used_) first_link_[bucket] = -1;
  used_.clear();
  links_.clear();
  moving_ = std::move(moving);
  for (std::uint32_t i = 0; i < moving_.size(); ++i) {
    for_each_bucket(*buckets_, moving_[i], [&](std::size_t bucket) {
      if (first_link_[bucket] < 0) used_.push_back(static_cast<std::uint32_t>(bucket));
      links_.push_back({i, first_link_[bucket]});
      first_link_[bucket] = static_cast<std::int32_t>(links_.size()) - 1;
    });
  }
}

/// Visits the buckets along the ray (Amanatides and Woo, 1987) by `visit(bucket, distance at which the ray
/// leaves it) -> bool`, until that says false.
template <class VisitBucket>
void RayCaster::walk(const SpaceRay& ray, VisitBucket&& visit) const {
  const Buckets& b = *buckets_;
  double enter = 0.0, leave = ray.max_m;
  for (int axis = 0; axis < 2; ++axis) {  // the part of the ray within the buckets
    const double d = ray.direction[axis], low = b.low[axis] - ray.from[axis],
                 high = b.high[axis] - ray.from[axis];
    if (d == 0 && (low > 0 || high < 0)) return;
    if (d == 0) continue;
    enter = std::max(enter, std::min(low / d, high / d));
    leave = std::min(leave, std::max(low / d, high / d));
  }
  if (enter > leave) return;
  const Vector2 start = ray.from + enter * ray.direction;
  int column = b.column_of(start.x()), row = b.row_of(start.y());
  const double dx = ray.direction.x(), dy = ray.direction.y();
  const int step_x = dx > 0 ? 1 : -1, step_y = dy > 0 ? 1 : -1;
  const double column_m = dx == 0 ? kNever : b.side_m / std::abs(dx);
  const double row_m = dy == 0 ? kNever : b.side_m / std::abs(dy);
  const auto first = [&](double low, double from, int index, double d) {
    return d == 0 ? kNever : (low + b.side_m * (index + (d > 0 ? 1 : 0)) - from) / d;
  };
  double next_column = first(b.low.x(), ray.from.x(), column, dx),
         next_row = first(b.low.y(), ray.from.y(), row, dy);
  while (column >= 0 && column < b.columns && row >= 0 && row < b.rows) {
    const double exit = std::min(next_column, next_row);
    if (!visit(static_cast<std::size_t>(row) * b.columns + column, exit) || exit > leave) return;
    if (next_column < next_row) {
      column += step_x;
      next_column += column_m;
    } else {
      row += step_y;
      next_row += row_m;
    }
  }
}

std::optional<RayHit> RayCaster::cast(const SpaceRay& ray) const {
  RayHit nearest = end_of(ray);
  walk(ray, [&](std::size_t bucket, double exit) {
    for (std::uint32_t i = buckets_->begin[bucket]; i < buckets_->begin[bucket + 1]; ++i) {
      keep_nearest(ray, buckets_->items[i], nearest);
    }
    for (std::int32_t link = first_link_[bucket]; link >= 0; link = links_[link].next) {
      keep_nearest(ray, moving_[links_[link].surface], nearest);
    }
    return nearest.distance_m > exit;
  });
  return found(ray, nearest);
}

std::optional<RayHit> RayCaster::cast_by_brute_force(const SpaceRay& ray) const {
  RayHit nearest = end_of(ray);
  for (const Surface& s : buckets_->items) keep_nearest(ray, s, nearest);
  for (const Surface& s : moving_) keep_nearest(ray, s, nearest);
  return found(ray, nearest);
}

void RayCaster::cast_through(const SpaceRay& ray, double full_height_m, std::vector<RayHit>& hits) const {
  hits.clear();
  double entered = 0.0;
  bool is_closed = false;
  walk(ray, [&](std::size_t bucket, double exit) {
    const auto add = [&](const Surface& face) {
      for_each_meeting(ray, face, [&](const Meeting& m) {  // a face in many buckets counts where it is met
        if (m.distance_m <= entered || m.distance_m > exit) return;
        hits.push_back({m.distance_m, m.cosine, &face, m.enters});
        is_closed |= face.low_m <= 0 && face.high_m >= full_height_m && !face.glass;
      });
    };
    for (std::uint32_t i = buckets_->begin[bucket]; i < buckets_->begin[bucket + 1]; ++i) {
      add(buckets_->items[i]);
    }
    for (std::int32_t link = first_link_[bucket]; link >= 0; link = links_[link].next) {
      add(moving_[links_[link].surface]);
    }
    entered = exit;
    return !is_closed;
  });
  std::sort(hits.begin(), hits.end(),
            [](const RayHit& a, const RayHit& b) { return a.distance_m < b.distance_m; });
}

}  // namespace dynslam
