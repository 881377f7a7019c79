// SPDX-License-Identifier: MIT
#include "bench/growth_plot.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "io/svg_text.h"

namespace dynslam::bench {
namespace {

// Pixels.
constexpr double kWidth = 900.0, kHeight = 560.0;
constexpr double kLeft = 80.0, kRight = 620.0, kTop = 40.0, kBottom = 500.0;
constexpr double kRow = 24.0;
constexpr const char* kColours[] = {"#2f7fc4", "#e0561b", "#007a5e", "#9c0824", "#a04a9e", "#3e4a5c"};

/// From logarithms to pixels.
struct Axes {
  double maps_from = 0.0, maps_to = 1.0;  ///< lg of the number of maps
  double ms_from = 0.0, ms_to = 1.0;      ///< lg of milliseconds, whole numbers

  Vector2 operator()(double lg_maps, double lg_ms) const {
    return {kLeft + (kRight - kLeft) * (lg_maps - maps_from) / (maps_to - maps_from),
            kBottom - (kBottom - kTop) * (lg_ms - ms_from) / (ms_to - ms_from)};
  }
};

Axes axes_for(const std::vector<GrowthSeries>& all) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Axes axes{kFar, -kFar, kFar, -kFar};
  for (const GrowthSeries& s : all) {
    for (const auto& [maps, ms] : s.points) {
      axes.ms_from = std::min(axes.ms_from, std::floor(std::log10(ms)));
      axes.ms_to = std::max(axes.ms_to, std::ceil(std::log10(ms)));
      if (s.points.size() < 2) continue;
      axes.maps_from = std::min(axes.maps_from, std::log10(maps));
      axes.maps_to = std::max(axes.maps_to, std::log10(maps));
    }
  }
  if (!(axes.maps_from < axes.maps_to)) axes.maps_from = 0.0, axes.maps_to = 3.0;
  if (!(axes.ms_from < axes.ms_to)) axes.ms_from = std::isfinite(axes.ms_from) ? axes.ms_from : 0.0;
  axes.ms_to = std::max(axes.ms_to, axes.ms_from + 1.0);
  return axes;
}

void write_grid(SvgText& svg, const Axes& axes) {
  svg << "<rect width='" << kWidth << "' height='" << kHeight << "' fill='#ffffff'/>\n<g stroke='#d5d9e0'>\n";
  for (double lg = axes.ms_from; lg <= axes.ms_to; ++lg)
    svg << "<path d='M" << axes(axes.maps_from, lg) << 'H' << kRight << "'/>\n";
  svg << "</g>\n<g text-anchor='end'>\n";
  for (double lg = axes.ms_from; lg <= axes.ms_to; ++lg) {
    svg << "<text x='" << kLeft - 8.0 << "' y='" << axes(axes.maps_from, lg).y() + 5.0 << "'>";
    lg < -2 ? svg << "1e" << static_cast<int>(lg) << "</text>\n" : svg << std::pow(10.0, lg) << "</text>\n";
  }
  svg << "</g>\n<text x='" << kLeft << "' y='" << kTop - 14.0 << "'>ms of one core</text>\n<text x='"
      << kRight << "' y='" << kBottom + 44.0 << "' text-anchor='end'>local maps</text>\n";
}

/// The numbers of maps that were measured, below the frame.
void write_sizes(SvgText& svg, const Axes& axes, const std::vector<GrowthSeries>& all) {
  const auto longest = std::max_element(
      all.begin(), all.end(), [](const auto& a, const auto& b) { return a.points.size() < b.points.size(); });
  if (longest == all.end() || longest->points.size() < 2) return;
  for (const auto& [maps, ms] : longest->points) {
    svg << "<text text-anchor='middle' x='" << axes(std::log10(maps), axes.ms_from).x() << "' y='"
        << kBottom + 22.0 << "'>" << maps << "</text>\n";
  }
}

/// A line that grows linearly, as far as the frame goes.
void write_linear(SvgText& svg, const Axes& axes) {
  const double to = std::min(axes.maps_to, axes.maps_from + axes.ms_to - axes.ms_from);
  svg << "<path fill='none' stroke='#8a93a3' stroke-dasharray='6 5' d='M"
      << axes(axes.maps_from, axes.ms_from) << 'L' << axes(to, axes.ms_from + to - axes.maps_from) << "'/>\n";
}

void write_series(SvgText& svg, const Axes& axes, const GrowthSeries& series, std::size_t row) {
  const char* colour = kColours[row % std::size(kColours)];
  const double y = kTop + 10.0 + kRow * static_cast<double>(row);
  svg << "<g fill='" << colour << "'><path fill='none' stroke='" << colour << "' stroke-width='2.5' d='";
  if (series.points.size() == 1) {
    svg << 'M' << axes(axes.maps_from, std::log10(series.points[0].ms)) << 'H' << kRight;
  } else {
    for (const auto& p : series.points)
      svg << (&p == series.points.data() ? 'M' : 'L') << axes(std::log10(p.maps), std::log10(p.ms));
  }
  svg << "'/><circle r='5' cx='" << kRight + 24.0 << "' cy='" << y - 5.0 << "'/><text x='" << kRight + 38.0
      << "' y='" << y << "'>" << xml_text(series.name);
  if (series.points.size() > 1) {
    svg << ": maps to the " << growth_exponent(series);
  } else {
    svg << ": no part in it";
  }
  svg << "</text></g>\n";
}

}  // namespace

double growth_exponent(const GrowthSeries& series) {
  const auto n = static_cast<double>(series.points.size());
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (const auto& [maps, ms] : series.points) {
    const double lg_maps = std::log(maps), lg_ms = std::log(ms);
    x += lg_maps, y += lg_ms, xx += lg_maps * lg_maps, xy += lg_maps * lg_ms;
  }
  const double spread = n * xx - x * x;
  return spread > 0.0 ? (n * xy - x * y) / spread : std::numeric_limits<double>::quiet_NaN();
}

std::string growth_svg(const std::vector<GrowthSeries>& all) {
  const Axes axes = axes_for(all);
  SvgText svg;
  svg << "<svg xmlns='http://www.w3.org/2000/svg' width='" << kWidth << "' height='" << kHeight
      << "' viewBox='0 0 " << kWidth << ' ' << kHeight << "' font-family='sans-serif' font-size='15'>\n"
      << "<title>What a finished local map costs</title>\n";
  write_grid(svg, axes);
  write_sizes(svg, axes, all);
  write_linear(svg, axes);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!all[i].points.empty()) write_series(svg, axes, all[i], i);
  }
  svg << "<text fill='#4c586b' x='" << kRight + 16.0 << "' y='"
      << kTop + 10.0 + kRow * static_cast<double>(all.size()) << "'>dashed: linear</text>\n</svg>\n";
  return svg.text();
}

}  // namespace dynslam::bench
