// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/world.h"

namespace dynslam {

/// What a world file says of a piece of furniture's form. What is not given has the shape's usual value.
struct FurnitureForm {
  std::string shape;
  std::optional<Vector2> size_m;  ///< along its x (the way it faces) and its y
  std::optional<double> radius_m;
  std::optional<double> low_m, high_m;
  std::optional<Colour> colour;
  Polygon points;
  double dark = 0.0;
  bool glass = false;
};

/// Names of the shapes, for messages.
const std::vector<std::string>& furniture_shapes();

/// The solids it is made of, in its own frame: origin in its middle, facing along x. REQUIRES: a known shape.
std::vector<Part> furniture_parts(const FurnitureForm& form);

}  // namespace dynslam
