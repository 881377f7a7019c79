// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "base/number_text.h"
#include "sim/robot_shape.h"
#include "sim/surface.h"
#include "sim/world.h"

namespace dynslam {
namespace {

/// Writes a drawing in the world's metres; y is flipped here, where picture begins.
class Svg {
 public:
  Svg(const Vector2& low, const Vector2& high) : low_(low), high_(high) {
    const Vector2 span = high - low;
    const double px_per_m = std::clamp(1400.0 / span.x(), 10.0, 100.0);
    text_ = R"(<svg xmlns="http://www.w3.org/2000/svg" width=")" + number(span.x() * px_per_m, 0) +
            "\" height=\"" + number(span.y() * px_per_m, 0) + "\" viewBox=\"0 0 " + number(span.x()) + ' ' +
            number(span.y()) +
            "\" stroke-linejoin=\"round\">\n<rect width=\"100%\" height=\"100%\" fill=\"#f4f2ee\"/>\n";
  }

  static std::string number(double value, int decimals = 3) {
    std::string text;
    append_fixed(text, value, decimals);
    return text;
  }
  static std::string hex(Colour c) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string text = "#";
    for (int shift = 20; shift >= 0; shift -= 4) text += kDigits[(c >> shift) & 15U];
    return text;
  }
  std::string place(const Vector2& p) const {
    return number(p.x() - low_.x()) + ',' + number(high_.y() - p.y());
  }

  void shape(const Part& part, const Pose2& world_T_thing, const std::string& style) {
    if (part.radius_m > 0) {
      const Vector2 p = world_T_thing * part.outline.front();
      text_ += "<circle cx=\"" + number(p.x() - low_.x()) + "\" cy=\"" + number(high_.y() - p.y()) +
               "\" r=\"" + number(part.radius_m) + "\" " + style + "/>\n";
      return;
    }
    Polygon corners;
    for (const Vector2& p : part.outline) corners.push_back(world_T_thing * p);
    line(corners, style, "polygon");
  }
  void line(const std::vector<Vector2>& points, const std::string& style,
            const std::string& element = "polyline") {
    text_ += '<' + element + " points=\"";
    for (const Vector2& p : points) text_ += place(p) + ' ';
    text_ += "\" " + style + "/>\n";
  }
  void label(const Vector2& p, const std::string& text, const std::string& style) {
    text_ += "<text x=\"" + number(p.x() - low_.x()) + "\" y=\"" + number(high_.y() - p.y()) +
             R"(" font-family="sans-serif" )" + style + '>';
    for (const char c : text) text_ += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
    text_ += "</text>\n";
  }
  std::string finished() { return text_ + "</svg>\n"; }

 private:
  Vector2 low_, high_;
  std::string text_;
};

std::string fill(Colour c, const std::string& more = "") { return "fill=\"" + Svg::hex(c) + "\" " + more; }

std::string stroke(const std::string& colour, double width_m, const std::string& more = "") {
  return R"(fill="none" stroke=")" + colour + "\" stroke-width=\"" + Svg::number(width_m) + "\" " + more;
}

void draw_furniture(const World& world, Svg& svg) {
  for (const Furniture& thing : world.furniture) {
    std::vector<Part> parts = thing.parts;
    std::stable_sort(parts.begin(), parts.end(),
                     [](const Part& a, const Part& b) { return a.high_m < b.high_m; });
    for (const Part& part : parts) {
      const bool is_overhead = part.low_m > kRobotHigh_m;  // what the robot passes under is drawn thin
      svg.shape(
          part, thing.world_T_thing,
          fill(part.colour, is_overhead ? R"(fill-opacity="0.6" stroke="#00000060" stroke-width="0.012")"
                                        : R"(stroke="#000000a0" stroke-width="0.015")"));
    }
    std::vector<Vector2> stations{thing.world_T_thing.translation()};
    for (const FurnitureMove& move : thing.moves) stations.push_back(move.to.translation());
    if (stations.size() > 1) svg.line(stations, stroke("#8a3ab9", 0.03, "stroke-dasharray=\"0.08\""));
  }
}

void draw_door(const Door& door, Svg& svg) {
  const Vector2 across = door.latch - door.hinge;
  const double closed = std::atan2(across.y(), across.x());
  std::vector<Vector2> arc;
  for (int i = 0; i <= 12; ++i) {
    arc.emplace_back(door.hinge + across.norm() * unit(closed + door.opens_rad * i / 12));
  }
  svg.line(arc, stroke("#b98a5e", 0.02, "stroke-dasharray=\"0.06\""));
  svg.line({door.hinge, door.hinge + across.norm() * unit(closed + door.opens_rad * door.open)},
           stroke(Svg::hex(door.colour), 0.05));
}

void draw_routes(const World& world, Svg& svg, double width_m) {
  for (const Person& person : world.people) {
    std::vector<Vector2> route = person.route;
    if (person.then == RouteEnd::kRound) route.push_back(route.front());
    svg.line(route, stroke(Svg::hex(person.colour), width_m, "stroke-dasharray=\"0.15 0.1\""));
    Part spot;
    spot.outline = {person.route.front()};
    spot.radius_m = 0.2;
    svg.shape(spot, {}, fill(person.colour));
  }
  std::vector<Vector2> tour = world.tour;
  tour.insert(tour.begin(), world.world_T_start.translation());
  svg.line(tour, stroke("#d23c3c", width_m, "stroke-opacity=\"0.7\""));
  for (std::size_t i = 1; i < tour.size(); ++i) {
    svg.label(tour[i], std::to_string(i), "font-size=\"" + Svg::number(6 * width_m) + R"(" fill="#a01818")");
  }
  const Pose2& start = world.world_T_start;
  svg.line(rectangle(start, kRobotLength_m, kRobotWidth_m), fill(0xd23c3c), "polygon");
  svg.line({start.translation(), start * Vector2(0.4, 0)}, stroke("#d23c3c", 0.04));
}

}  // namespace

std::string to_svg(const World& world) {
  Vector2 low = world.world_T_start.translation(), high = low;
  for (const Surface& s : fixed_surfaces(world)) {
    low = low.cwiseMin(s.from);
    high = high.cwiseMax(s.from);
  }
  Svg svg(low.array() - 0.3, high.array() + 0.3);
  for (const FloorPatch& floor : world.floors)
    svg.line(floor.outline, fill(floor.colour, "fill-opacity=\"0.45\""), "polygon");
  for (const Doorstep& step : world.doorsteps) {
    svg.line({step.from, step.to}, stroke("#6b5b4b", step.depth_m, "stroke-opacity=\"0.6\""));
  }
  draw_furniture(world, svg);
  for (const Wall& wall : world.walls) {
    for (const Part& part : wall_parts(wall)) svg.shape(part, {}, fill(wall.glass ? 0x8fc3d8 : 0x3b3f46));
  }
  for (const Door& door : world.doors) draw_door(door, svg);
  draw_routes(world, svg, (high - low).maxCoeff() > 30 ? 0.08 : 0.03);
  return svg.finished();
}

}  // namespace dynslam
