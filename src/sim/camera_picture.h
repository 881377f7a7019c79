// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "sim/floor_look.h"
#include "sim/life.h"
#include "sim/ray_caster.h"

namespace dynslam {

/// Rows from the top, a pixel as 0x00RRGGBB.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint32_t> pixels;
};

/// Draws what the robot's camera sees, column by column: faces by their heights from far to near, shaded by
/// how they stand to the light, the undersides of tables, floor and ceiling. One thread.
class CameraPicture {
 public:
  explicit CameraPicture(const World& world);

  /// The picture stays until the next call.
  const Picture& draw(const CameraView& view);

  static constexpr int kWidth = 960, kHeight = 540;
  static constexpr double kForward_m = 0.10, kEyeHeight_m = 0.20, kLooksUp_rad = 0.10;
  static constexpr double kFocal_px = 740.0;  ///< 66 degrees across

 private:
  /// How heights and distances along one column's ray become rows.
  struct Column {
    int x = 0;
    Vector2 eye = Vector2::Zero(), direction = Vector2::UnitX();
    double eye_m = 0.0;    ///< height of the eye
    double cosine = 1.0;   ///< of the column's bearing: depth for each metre along the ray
    double horizon = 0.0;  ///< row

    double row_of(double height_m, double distance_m) const {
      return horizon - kFocal_px * (height_m - eye_m) / (distance_m * cosine);
    }
    double distance_of(double row, double height_m) const {
      return kFocal_px * (eye_m - height_m) / ((row - horizon) * cosine);
    }
  };

  Column column_of(int x, const CameraView& view) const;
  void draw_column(const Column& column);
  void draw_face(const Column& column, const RayHit& hit);
  /// Undersides and tops of the parts that the ray is within between two distances.
  void draw_levels(const Column& column, double near_m, double far_m);
  void draw_floor(const Column& column, double from_row);
  void draw_ceiling(const Column& column, double to_row);
  /// Calls `colour(row)` for the rows between two heights in the picture.
  template <class ColourOf>
  void fill(const Column& column, double top, double bottom, ColourOf&& colour);

  RayCaster caster_;
  FloorLook floor_;
  double ceiling_m_ = 2.5;
  std::vector<RayHit> hits_;
  std::vector<const Surface*> within_;  ///< a face of each part that the ray is within
  Picture picture_;
};

/// Throws std::runtime_error when the encoder fails.
std::vector<std::uint8_t> encode_jpeg(const Picture& picture);

}  // namespace dynslam
