// SPDX-License-Identifier: MIT
#include "sim/furniture.h"

#include <functional>
#include <map>

namespace dynslam {
namespace {

using Parts = std::vector<Part>;

/// A form with nothing left open.
struct Form {
  double length_m, width_m, radius_m, low_m, high_m;
  Colour colour;
  const FurnitureForm& given;
};

Colour darker(Colour c, double share) {
  const auto channel = [&](int shift) {
    return static_cast<Colour>(static_cast<double>((c >> shift) & 255U) * share) << shift;
  };
  return channel(16) | channel(8) | channel(0);
}

Part made(const Form& f, Polygon outline, double radius_m, double low_m, double high_m, Colour colour) {
  return {std::move(outline), radius_m, low_m, high_m, colour, f.given.dark, f.given.glass};
}

Part slab(const Form& f, const Vector2& middle, const Vector2& size, double low_m, double high_m,
          Colour colour) {
  return made(f, rectangle({middle.x(), middle.y(), 0.0}, size.x(), size.y()), 0.0, low_m, high_m, colour);
}

Part post(const Form& f, double radius_m, double low_m, double high_m, Colour colour) {
  return made(f, {Vector2::Zero()}, radius_m, low_m, high_m, colour);
}

void add_legs(const Form& f, double thick_m, double low_m, double high_m, Colour colour, Parts& parts) {
  const double x = (f.length_m - thick_m) / 2, y = (f.width_m - thick_m) / 2;
  for (const Vector2& at : {Vector2(-x, -y), Vector2(x, -y), Vector2(x, y), Vector2(-x, y)}) {
    parts.push_back(slab(f, at, {thick_m, thick_m}, low_m, high_m, colour));
  }
}

Parts box(const Form& f) { return {slab(f, {0, 0}, {f.length_m, f.width_m}, f.low_m, f.high_m, f.colour)}; }

Parts round_thing(const Form& f) { return {post(f, f.radius_m, f.low_m, f.high_m, f.colour)}; }

Parts polygon(const Form& f) { return {made(f, f.given.points, 0.0, f.low_m, f.high_m, f.colour)}; }

Parts table(const Form& f) {
  Parts parts;
  add_legs(f, 0.05, f.low_m, f.high_m - 0.04, darker(f.colour, 0.75), parts);
  parts.push_back(slab(f, {0, 0}, {f.length_m, f.width_m}, f.high_m - 0.04, f.high_m, f.colour));
  return parts;
}

/// A table on two side panels; whoever sits there faces against its x.
Parts desk(const Form& f) {
  Parts parts;
  for (const double side : {-1.0, 1.0}) {
    parts.push_back(slab(f, {0, side * (f.width_m - 0.04) / 2}, {f.length_m - 0.06, 0.04}, f.low_m,
                         f.high_m - 0.03, darker(f.colour, 0.8)));
  }
  parts.push_back(slab(f, {0, 0}, {f.length_m, f.width_m}, f.high_m - 0.03, f.high_m, f.colour));
  parts.push_back(slab(f, {-f.length_m / 4, 0}, {0.04, 0.55}, f.high_m + 0.08, f.high_m + 0.42, 0x202326));
  parts.push_back(slab(f, {-f.length_m / 4, 0}, {0.06, 0.06}, f.high_m, f.high_m + 0.08, 0x202326));
  return parts;
}

Parts chair(const Form& f) {
  Parts parts;
  const double seat = f.low_m + 0.45;
  add_legs(f, 0.04, f.low_m, seat - 0.04, darker(f.colour, 0.7), parts);
  parts.push_back(slab(f, {0, 0}, {f.length_m, f.width_m}, seat - 0.04, seat, f.colour));
  parts.push_back(slab(f, {-f.length_m / 2 + 0.02, 0}, {0.04, f.width_m}, seat + 0.12, f.high_m, f.colour));
  return parts;
}

Parts office_chair(const Form& f) {
  Parts parts;
  for (int i = 0; i < 5; ++i) {  // the star foot
    const double angle = i * kTwoPi / 5;
    const Vector2 middle = 0.15 * unit(angle);
    parts.push_back(
        made(f, rectangle({middle.x(), middle.y(), angle}, 0.28, 0.04), 0.0, f.low_m, 0.11, 0x2a2a2c));
  }
  parts.push_back(post(f, 0.03, 0.11, 0.42, 0x2a2a2c));
  parts.push_back(slab(f, {0, 0}, {f.length_m, f.width_m}, 0.42, 0.50, f.colour));
  parts.push_back(slab(f, {-f.length_m / 2 + 0.03, 0}, {0.06, f.width_m * 0.9}, 0.58, f.high_m, f.colour));
  return parts;
}

Parts sofa(const Form& f) {
  const double arm = 0.16, back = 0.22;
  Parts parts{slab(f, {back / 2, 0}, {f.length_m - back, f.width_m - 2 * arm}, f.low_m, 0.43, f.colour)};
  parts.push_back(
      slab(f, {-(f.length_m - back) / 2, 0}, {back, f.width_m}, f.low_m, f.high_m, darker(f.colour, 0.9)));
  for (const double side : {-1.0, 1.0}) {
    parts.push_back(slab(f, {back / 2, side * (f.width_m - arm) / 2}, {f.length_m - back, arm}, f.low_m, 0.60,
                         darker(f.colour, 0.85)));
  }
  return parts;
}

Parts bed(const Form& f) {
  Parts parts{slab(f, {0, 0}, {f.length_m, f.width_m}, f.low_m, 0.32, 0x8a6a48)};
  parts.push_back(slab(f, {0.02, 0}, {f.length_m - 0.06, f.width_m - 0.04}, 0.32, f.high_m, f.colour));
  parts.push_back(slab(f, {-f.length_m / 2 + 0.03, 0}, {0.06, f.width_m}, 0.0, f.high_m + 0.45, 0x8a6a48));
  return parts;
}

/// Uprights at the corners and boards between them, 1.5 m apart.
Parts rack(const Form& f) {
  Parts parts;
  add_legs(f, 0.1, f.low_m, f.high_m, 0x2f5fa8, parts);
  for (double z = 1.5; z < f.high_m; z += 1.5) {
    parts.push_back(slab(f, {0, 0}, {f.length_m, f.width_m}, z, z + 0.12, 0xd9782d));
  }
  return parts;
}

Parts plant(const Form& f) {
  return {post(f, f.radius_m, f.low_m, 0.35, 0xa65a3a), post(f, 0.04, 0.35, 0.6, 0x6b5235),
          post(f, f.radius_m * 1.6, 0.6, f.high_m, f.colour)};
}

struct Shape {
  Vector2 size;
  double radius_m, low_m, high_m;
  Colour colour;
  std::function<Parts(const Form&)> make;
};

const std::map<std::string, Shape, std::less<>>& shapes() {
  static const std::map<std::string, Shape, std::less<>> kAll = {
      {"box", {{0.5, 0.5}, 0, 0.0, 1.0, 0xb0936c, box}},
      {"round", {{0, 0}, 0.2, 0.0, 1.0, 0xa0a0a0, round_thing}},
      {"polygon", {{0, 0}, 0, 0.0, 1.0, 0xb0936c, polygon}},
      {"table", {{0.8, 1.4}, 0, 0.0, 0.74, 0xc49a63, table}},
      {"desk", {{0.8, 1.6}, 0, 0.0, 0.74, 0xd8d2c4, desk}},
      {"chair", {{0.45, 0.43}, 0, 0.0, 0.90, 0xa9763f, chair}},
      {"office_chair", {{0.5, 0.48}, 0, 0.0, 1.05, 0x3c4652, office_chair}},
      {"sofa", {{0.9, 2.0}, 0, 0.05, 0.82, 0x5f7f8c, sofa}},
      {"bed", {{2.05, 1.6}, 0, 0.10, 0.52, 0xdfe3ea, bed}},
      {"rack", {{2.7, 1.1}, 0, 0.0, 4.6, 0x2f5fa8, rack}},
      {"plant", {{0, 0}, 0.16, 0.0, 1.3, 0x4c8a4a, plant}},
  };
  return kAll;
}

}  // namespace

const std::vector<std::string>& furniture_shapes() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> all;
    for (const auto& [name, shape] : shapes()) all.push_back(name);
    return all;
  }();
  return kNames;
}

std::vector<Part> furniture_parts(const FurnitureForm& form) {
  const Shape& shape = shapes().at(form.shape);
  const Vector2 size = form.size_m.value_or(shape.size);
  return shape.make({size.x(), size.y(), form.radius_m.value_or(shape.radius_m),
                     form.low_m.value_or(shape.low_m), form.high_m.value_or(shape.high_m),
                     form.colour.value_or(shape.colour), form});
}

}  // namespace dynslam
