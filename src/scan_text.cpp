// SPDX-License-Identifier: MIT
#include "scan_text.h"

#include <cmath>
#include <vector>

namespace dynslam {

std::string scan_text(const Scan& scan, double radius_m, int rows) {
  const int columns = 2 * rows;
  std::vector<std::string> lines(static_cast<std::size_t>(rows),
                                 std::string(static_cast<std::size_t>(columns), ' '));
  const auto put = [&](const Vector2& robot_p, char c) {
    const double up = 0.5 - 0.5 * robot_p.x() / radius_m, left = 0.5 - 0.5 * robot_p.y() / radius_m;
    if (!(up >= 0.0 && up < 1.0 && left >= 0.0 && left < 1.0)) return;
    lines[static_cast<std::size_t>(up * rows)][static_cast<std::size_t>(left * columns)] = c;
  };
  const double side = scan.mount.upside_down ? -1.0 : 1.0;
  for (const Beam& beam : scan.beams) {
    if (!is_return(beam) || !std::isfinite(beam.angle_rad)) continue;
    const double angle = side * beam.angle_rad;
    put(scan.mount.robot_T_lidar * Vector2(beam.range_m * std::cos(angle), beam.range_m * std::sin(angle)),
        '#');
  }
  put(Vector2::Zero(), '^');
  std::string text;
  for (const std::string& line : lines) text += "  |" + line + "|\n";
  return text;
}

}  // namespace dynslam
