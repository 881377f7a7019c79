// SPDX-License-Identifier: MIT
#include "io/scan_fan.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angles.h"

namespace dynslam {
namespace {

constexpr double kMostError_rad = 2.5e-4;
constexpr int kFinest = 16;  // places for each beam
constexpr float kNoBeam = std::numeric_limits<float>::quiet_NaN();

/// A beam and its angle after the first beam's, going on over full turns.
struct Turned {
  double angle_rad = 0.0;
  Beam beam;
};

/// In the order in which the lidar turns; counter-clockwise or not is what the last beam says.
std::vector<Turned> turned(const Scan& scan) {
  std::vector<Turned> beams;
  for (const Beam& beam : scan.beams) {
    if (!std::isfinite(beam.angle_rad) || !std::isfinite(beam.time_s)) continue;
    const double angle =
        beams.empty() ? 0.0 : beams.back().angle_rad + turn(beams.back().beam.angle_rad, beam.angle_rad);
    beams.push_back({angle, beam});
  }
  const double side = !beams.empty() && beams.back().angle_rad < 0.0 ? -1.0 : 1.0;
  std::stable_sort(beams.begin(), beams.end(), [side](const Turned& a, const Turned& b) {
    return side * a.angle_rad < side * b.angle_rad;
  });
  return beams;
}

/// What of two readings at one place counts: the nearer return, or whatever is no return.
float nearer(float a, float b) { return std::isnan(a) || b < a ? b : a; }

struct Places {
  double step_rad = 0.0;
  std::vector<long> of_beam;  ///< which reading each becomes
  bool good = true;           ///< near enough to its angle, and each at one of its own
};

Places places_at(const std::vector<Turned>& beams, double step_rad) {
  Places places{step_rad, {}, true};
  for (const Turned& beam : beams) {
    const double angle = beam.angle_rad - beams.front().angle_rad;
    const auto place = std::lround(angle / step_rad);
    const double error = std::abs(angle - static_cast<double>(place) * step_rad);
    if (error > kMostError_rad || (!places.of_beam.empty() && place == places.of_beam.back()))
      places.good = false;
    places.of_beam.push_back(place);
  }
  return places;
}

/// The widest equal steps that hold all beams where they are. REQUIRES: not all at one angle.
Places find_places(const std::vector<Turned>& beams) {
  const double mean =
      (beams.back().angle_rad - beams.front().angle_rad) / static_cast<double>(beams.size() - 1);
  for (int k = 1;; k *= 2) {
    Places places = places_at(beams, mean / k);
    if (places.good || k == kFinest) return places;
  }
}

}  // namespace

ScanFan to_fan(const Scan& scan) {
  ScanFan fan;
  fan.stamp = scan.stamp;
  const std::vector<Turned> beams = turned(scan);
  if (beams.empty()) return fan;
  const Beam &first = beams.front().beam, &last = beams.back().beam;
  fan.stamp += from_seconds(first.time_s);
  fan.first_rad = first.angle_rad;
  Places places{0.0, std::vector<long>(beams.size(), 0), true};
  if (beams.back().angle_rad != beams.front().angle_rad) places = find_places(beams);
  const long last_place = places.of_beam.back();
  fan.step_rad = static_cast<float>(places.step_rad);
  if (last_place > 0)
    fan.time_step_s = std::max(0.0F, (last.time_s - first.time_s) / static_cast<float>(last_place));
  fan.ranges_m.assign(static_cast<std::size_t>(last_place) + 1, kNoBeam);
  for (std::size_t i = 0; i < beams.size(); ++i) {
    float& reading = fan.ranges_m[static_cast<std::size_t>(places.of_beam[i])];
    reading = nearer(reading, beams[i].beam.range_m);
  }
  return fan;
}

void drop_gaps(Scan& scan) {
  const auto is_nan = [](const Beam& beam) { return std::isnan(beam.range_m); };
  const auto nans = std::count_if(scan.beams.begin(), scan.beams.end(), is_nan);
  if (2 * static_cast<std::size_t>(nans) >= scan.beams.size()) std::erase_if(scan.beams, is_nan);
}

}  // namespace dynslam
