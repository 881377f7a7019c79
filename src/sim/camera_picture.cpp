// SPDX-License-Identifier: MIT
#include "sim/camera_picture.h"

#include <algorithm>
#include <cmath>

namespace dynslam {
namespace {

constexpr double kNearest_m = 0.02;
constexpr float kFogRange_m = 45.0F;
const Rgb kFog{214, 214, 210};
const Rgb kCeiling{240, 238, 232};

std::uint32_t packed(const Rgb& c) {
  const auto channel = [](float v) { return static_cast<std::uint32_t>(std::clamp(v, 0.0F, 255.0F)); };
  return channel(c.r) << 16 | channel(c.g) << 8 | channel(c.b);
}

Rgb in_fog(const Rgb& c, double distance_m) {
  return mixed(c, kFog, std::min(0.7F, static_cast<float>(distance_m) / kFogRange_m));
}

/// How much light falls on a face, by where its outside points: from a window to the left, and all around.
float light_on(const RayHit& hit, const Vector2& at, const Vector2& looking) {
  static const Vector2 kToLight = Vector2(-0.45, 0.89);
  const Surface& s = *hit.surface;
  Vector2 out = s.radius_m > 0 ? Vector2(at - s.from) : Vector2(s.along.y(), -s.along.x());
  out.normalize();
  if (out.dot(looking) > 0) out = -out;
  return 0.80F + 0.20F * static_cast<float>(out.dot(kToLight));
}

}  // namespace

CameraPicture::CameraPicture(const World& world)
    : caster_(fixed_surfaces(world), Actors::reach(world)), floor_(world, fixed_surfaces(world)) {
  for (const Wall& wall : world.walls) ceiling_m_ = std::max(ceiling_m_, wall.height_m);
  picture_.width = kWidth;
  picture_.height = kHeight;
  picture_.pixels.assign(static_cast<std::size_t>(kWidth) * kHeight, 0);
}

CameraPicture::Column CameraPicture::column_of(int x, const CameraView& view) const {
  const BodyPose& pose = view.pose;
  const double across = (kWidth / 2.0 - x - 0.5) / kFocal_px;  // to the left
  Column c;
  c.x = x;
  c.eye = pose.world_T_robot * Vector2(kForward_m, 0);
  c.direction = unit(pose.world_T_robot.yaw + std::atan(across));
  c.cosine = 1.0 / std::hypot(1.0, across);
  c.eye_m = kEyeHeight_m + pose.lift_m + kForward_m * std::sin(pose.nose_up_rad);
  c.horizon = kHeight / 2.0 +
              kFocal_px * (std::tan(kLooksUp_rad + pose.nose_up_rad) + across * std::tan(pose.left_up_rad));
  return c;
}

template <class ColourOf>
void CameraPicture::fill(const Column& c, double top, double bottom, ColourOf&& colour) {
  const int first = static_cast<int>(std::clamp(std::ceil(top - 0.5), 0.0, double(kHeight)));
  const int end = static_cast<int>(std::clamp(std::ceil(bottom - 0.5), 0.0, double(kHeight)));
  std::uint32_t* pixel =
      &picture_.pixels[static_cast<std::size_t>(c.x)] + static_cast<std::ptrdiff_t>(first) * kWidth;
  for (int row = first; row < end; ++row, pixel += kWidth) *pixel = packed(colour(row + 0.5));
}

void CameraPicture::draw_face(const Column& c, const RayHit& hit) {
  const Surface& s = *hit.surface;
  const Vector2 at = c.eye + hit.distance_m * c.direction;
  const float light = light_on(hit, at, c.direction);
  const Rgb lit = in_fog(rgb_of(s.colour) * light, hit.distance_m);
  const double top = c.row_of(s.high_m, hit.distance_m), bottom = c.row_of(s.low_m, hit.distance_m);
  if (s.glass) {  // a tint, and a frame at its edges
    fill(c, top, bottom, [&](double row) {
      const std::uint32_t behind = picture_.pixels[static_cast<std::size_t>(row) * kWidth + c.x];
      return mixed(rgb_of(behind), lit, 0.25F);
    });
    return;
  }
  const bool is_wall = s.low_m <= 0 && s.high_m >= ceiling_m_;
  const double skirting = is_wall ? c.row_of(0.07, hit.distance_m) : bottom;
  const double shade_rows = bottom - c.row_of(s.low_m + 0.35, hit.distance_m);  // darker towards the floor
  const bool stands = s.low_m < 0.15;
  fill(c, top, bottom, [&](double row) {
    if (row > skirting) return lit * 0.86F;
    const double up = (bottom - row) / shade_rows;
    return stands && up < 1 ? lit * static_cast<float>(0.86 + 0.14 * up) : lit;
  });
}

void CameraPicture::draw_levels(const Column& c, double near_m, double far_m) {
  for (const Surface* s : within_) {
    const Rgb colour = in_fog(rgb_of(s->colour), near_m);
    if (s->low_m > c.eye_m) {
      fill(c, c.row_of(s->low_m, near_m), c.row_of(s->low_m, far_m), [&](double) { return colour * 0.55F; });
    } else if (s->high_m < c.eye_m) {
      fill(c, c.row_of(s->high_m, far_m), c.row_of(s->high_m, near_m),
           [&](double) { return colour * 1.08F; });
    }
  }
}

void CameraPicture::draw_floor(const Column& c, double from_row) {
  fill(c, std::max(from_row, c.horizon + 1.0), kHeight, [&](double row) {
    const double distance = c.distance_of(row, 0.0);
    return in_fog(floor_.at(c.eye + distance * c.direction, distance), distance);
  });
}

void CameraPicture::draw_ceiling(const Column& c, double to_row) {
  fill(c, 0.0, to_row, [&](double row) {
    const double distance = row < c.horizon - 1.0 ? c.distance_of(row, ceiling_m_) : 1e3;
    return in_fog(kCeiling, distance);
  });
}

void CameraPicture::draw_column(const Column& c) {
  SpaceRay ray;
  ray.from = c.eye;
  ray.direction = c.direction;
  caster_.cast_through(ray, ceiling_m_, hits_);
  std::erase_if(hits_, [](const RayHit& h) { return h.distance_m < kNearest_m; });
  std::size_t last = 0;  // what closes the view
  const auto is_closing = [&](const RayHit& h) {
    return h.surface->low_m <= 0 && h.surface->high_m >= ceiling_m_ && !h.surface->glass;
  };
  while (last < hits_.size() && !is_closing(hits_[last])) ++last;
  const bool is_closed = last < hits_.size();
  const double far_m = is_closed ? hits_[last].distance_m : 1e3;
  draw_ceiling(c, is_closed ? c.row_of(ceiling_m_, far_m) : c.horizon + 1.0);
  draw_floor(c, c.row_of(0.0, far_m));
  hits_.resize(is_closed ? last + 1 : hits_.size());
  const auto leave = [&](const Surface* of) {
    std::erase_if(within_, [&](auto* s) { return s->part == of->part; });
  };
  within_.clear();
  for (const RayHit& hit : hits_) hit.enters ? within_.push_back(hit.surface) : leave(hit.surface);
  double behind_m = far_m;
  for (auto hit = hits_.rbegin(); hit != hits_.rend(); ++hit) {  // and now from far to near
    draw_levels(c, hit->distance_m, behind_m);
    hit->enters ? leave(hit->surface) : within_.push_back(hit->surface);
    draw_face(c, *hit);
    behind_m = hit->distance_m;
  }
  draw_levels(c, kNearest_m, behind_m);  // whose table the robot stands under
}

const Picture& CameraPicture::draw(const CameraView& view) {
  caster_.set_moving(view.moving);
  for (int x = 0; x < kWidth; ++x) draw_column(column_of(x, view));
  return picture_;
}

}  // namespace dynslam
