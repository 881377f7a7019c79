// SPDX-License-Identifier: MIT
#include "io/graph_picture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <string_view>

#include <Eigen/Geometry>

#include "io/graph_legend.h"
#include "io/scale_length.h"
#include "io/svg_text.h"
#include "io/wall_runs.h"

namespace dynslam {
namespace {

// Pixels.
constexpr double kWidth = 1200.0;
constexpr double kMargin = 20.0;
constexpr double kLegendWidth = 270.0;
constexpr double kMapWidth = kWidth - 3.0 * kMargin - kLegendWidth;
constexpr double kMostMapHeight = 900.0;
constexpr double kLeastMapHeight = 200.0;
constexpr double kRim = 16.0;  // around what the map shows
constexpr double kScaleRoom = 40.0;
constexpr double kLegendRow = 23.0;
constexpr double kWallBlock = 1.5;  // least side

constexpr double kMostPixelsPerMetre = 100.0;
constexpr double kFarthest_m = 1e6;
constexpr double kManyMaps = 150.0;  // of more, lines and nodes are drawn thinner

bool is_placeable(const Vector2& p) { return p.allFinite() && p.cwiseAbs().maxCoeff() <= kFarthest_m; }
bool is_placeable(const Pose2& p) { return is_finite(p) && is_placeable(p.translation()); }

/// Where the frame of the map lies in the picture.
struct Frame {
  double px_per_m = kMostPixelsPerMetre;
  double height = kLeastMapHeight;  ///< of the map's part of the picture
  Vector2 centre_map{0.0, 0.0};

  /// The one place where y is flipped.
  Vector2 operator()(const Vector2& point_map) const {
    const Vector2 p = px_per_m * (point_map - centre_map);
    return {kMargin + kMapWidth / 2.0 + p.x(), kMargin + height / 2.0 - p.y()};
  }
};

class GraphDrawing {
 public:
  GraphDrawing(const GraphPicture& graph, const TrinaryMap& map) : graph_(graph), map_(map) {
    for (const PicturedMap& m : graph.maps) {
      if (is_placeable(m.map_T_origin)) places_[m.id] = m.map_T_origin;
    }
    line_ = std::clamp(std::sqrt(kManyMaps / static_cast<double>(graph.maps.size() + 1)), 0.4, 1.0);
    fit_frame();
  }

  std::string draw();

 private:
  struct Ends {  ///< of a line between two local maps, in the picture
    Vector2 a, b;
  };

  void fit_frame();
  void begin(double height);
  void write_map();
  void write_walls();
  void write_path();
  void write_loops(const std::vector<PicturedLoop>& loops, std::string_view style, std::string_view name);
  void write_edges(PicturedEdge::Kind kind, std::string_view style, std::string_view name);
  void write_closures();
  void write_edge(const PicturedEdge& edge, std::string_view style, std::string_view name);
  void write_nodes();
  void write_scale_bar();
  void write_legend(const std::vector<LegendRow>& rows);
  std::optional<Ends> ends_of(std::uint32_t a, std::uint32_t b) const;
  std::optional<Vector2> ghost_of(const PicturedLoop& loop) const;
  std::size_t left_out() const;

  const GraphPicture& graph_;
  const TrinaryMap& map_;
  std::map<std::uint32_t, Pose2> places_;  ///< map_T_origin of those that have a place
  Frame frame_;
  double line_ = 1.0;  ///< what the thickness of lines is multiplied by
  SvgText svg_;
};

/// Shows the walls, the local maps and the path. Loops that are not believed may lead out of the picture: one
/// to the other end of the world should not make the building a dot.
void GraphDrawing::fit_frame() {
  Eigen::AlignedBox2d box = walls_box_map(map_);
  for (const auto& [id, map_T_origin] : places_) box.extend(map_T_origin.translation());
  for (const Vector2& p : graph_.path_map) {
    if (is_placeable(p)) box.extend(p);
  }
  if (box.isEmpty()) return;
  const Vector2 size_m = box.sizes().cwiseMax(1e-3);
  frame_.centre_map = box.center();
  frame_.px_per_m = std::min({kMostPixelsPerMetre, (kMapWidth - 2.0 * kRim) / size_m.x(),
                              (kMostMapHeight - 2.0 * kRim) / size_m.y()});
  frame_.height = std::max(kLeastMapHeight, frame_.px_per_m * size_m.y() + 2.0 * kRim);
}

std::optional<GraphDrawing::Ends> GraphDrawing::ends_of(std::uint32_t a, std::uint32_t b) const {
  const auto at_a = places_.find(a), at_b = places_.find(b);
  if (at_a == places_.end() || at_b == places_.end()) return std::nullopt;
  return Ends{frame_(at_a->second.translation()), frame_(at_b->second.translation())};
}

/// Where in the picture a loop would have put its second map.
std::optional<Vector2> GraphDrawing::ghost_of(const PicturedLoop& loop) const {
  const auto a = places_.find(loop.a);
  if (a == places_.end() || !is_placeable(loop.a_T_b)) return std::nullopt;
  return frame_((a->second * loop.a_T_b).translation());
}

std::size_t GraphDrawing::left_out() const {
  std::size_t count = 0;
  for (const PicturedMap& m : graph_.maps) count += is_placeable(m.map_T_origin) ? 0 : 1;
  for (const PicturedEdge& e : graph_.edges) count += ends_of(e.a, e.b) ? 0 : 1;
  for (const auto* loops : {&graph_.refused, &graph_.let_go}) {
    for (const PicturedLoop& l : *loops) count += ends_of(l.a, l.b) && ghost_of(l) ? 0 : 1;
  }
  return count;
}

// Closures differ in thickness and lightness too, not by hue alone; what is not believed is dashed.
void GraphDrawing::begin(double height) {
  svg_ << "<svg xmlns='http://www.w3.org/2000/svg' width='" << kWidth << "' height='" << height
       << "' viewBox='0 0 " << kWidth << ' ' << height << "' font-family='sans-serif' font-size='15'"
       << " fill='#1e2633'>\n<title>The pose graph</title>\n<style>\n"
       << ":root{max-width:100%;height:auto}\n"  // fits a phone, too
       << "path{fill:none;stroke-linejoin:round}\n";
  const auto line = [&](const char* kind, const char* colour, double width, const char* more) {
    svg_ << '.' << kind << "{stroke:" << colour << ";stroke-width:" << width * line_ << more << "}\n";
  };
  line("path", "#9db8dc", 1.6, "");
  line("turn", "#007a5e", 4.0, ";stroke-dasharray:1.5 4");
  line("odometry", "#3e4a5c", 1.4, "");
  line("band0", "#2f7fc4", 1.8, "");
  line("band1", "#e3a400", 2.6, "");
  line("band2", "#e0561b", 3.6, "");
  line("band3", "#9c0824", 5.0, "");
  line("refused", "#a04a9e", 1.2, "");
  line("let_go", "#000000", 1.8, "");
  line("active", "#ffffff", 1.0, ";fill:#1e2633");
  line("retired", "#1e2633", 1.4, ";fill:#ffffff");
  svg_ << ".walls{stroke:#b6bcc7;stroke-width:1.05}\n.dashed{stroke-dasharray:6 4}\n"
       << ".scale{stroke:#1e2633;stroke-width:2}\n.detail{font-size:13px;fill:#4c586b}\n"
       << "</style>\n<rect width='" << kWidth << "' height='" << height << "' fill='#ffffff'/>\n";
}

void GraphDrawing::write_walls() {
  const double cell_px = frame_.px_per_m * map_.cell_size_m;
  const int cells = static_cast<int>(std::clamp(std::ceil(kWallBlock / cell_px), 1.0, 1e6));
  const Vector2 corner_map =
      map_.cell_size_m * Vector2(map_.origin.x, static_cast<double>(map_.origin.y) + map_.height);
  svg_ << "<path class='walls' transform='translate(" << frame_(corner_map) << ") scale("
       << shortest_text(cells * cell_px) << ")' d='" << wall_runs(map_, cells) << "'/>\n";
}

/// Steps of less than a pixel are skipped: a robot that stands still adds a point each scan.
void GraphDrawing::write_path() {
  svg_ << "<path class='path' d='";
  std::optional<Vector2> last;
  for (const Vector2& p : graph_.path_map) {
    if (!is_placeable(p)) continue;
    const Vector2 next = frame_(p);
    if (last && (next - *last).norm() < 1.0) continue;
    svg_ << (last ? 'L' : 'M') << next;
    last = next;
  }
  svg_ << "'/>\n";
}

void GraphDrawing::write_loops(const std::vector<PicturedLoop>& loops, std::string_view style,
                               std::string_view name) {
  for (const PicturedLoop& loop : loops) {
    const auto ends = ends_of(loop.a, loop.b);
    const auto ghost = ghost_of(loop);
    if (!ends || !ghost) continue;
    svg_ << "<g class='" << style << "'><title>" << name << ' ' << loop.a << " – " << loop.b << ": "
         << xml_text(loop.reason) << "</title><path class='dashed' d='M" << ends->a << 'L' << *ghost
         << "'/><path d='M" << ends->b << 'L' << *ghost << "m-3 -3l6 6m0 -6l-6 6'/></g>\n";
  }
}

void GraphDrawing::write_edge(const PicturedEdge& edge, std::string_view style, std::string_view name) {
  const auto ends = ends_of(edge.a, edge.b);
  if (!ends) return;
  svg_ << "<path class='" << style << "' d='M" << ends->a << 'L' << ends->b << "'><title>" << name << ' '
       << edge.a << " – " << edge.b << ": ";
  if (std::isfinite(edge.residual)) {
    svg_ << edge.residual << " σ off</title></path>\n";
  } else {
    svg_ << "not known how far off</title></path>\n";
  }
}

void GraphDrawing::write_edges(PicturedEdge::Kind kind, std::string_view style, std::string_view name) {
  for (const PicturedEdge& edge : graph_.edges) {
    if (edge.kind == kind) write_edge(edge, style, name);
  }
}

/// The loud ones over the calm ones.
void GraphDrawing::write_closures() {
  for (int band = 0; band < kClosureBands; ++band) {
    const std::string style = "closure band" + std::to_string(band);
    for (const PicturedEdge& edge : graph_.edges) {
      const bool is_of_band = edge.kind == PicturedEdge::Kind::kLoop && closure_band(edge.residual) == band;
      if (is_of_band) write_edge(edge, style, "closure");
    }
  }
}

void GraphDrawing::write_nodes() {
  for (const PicturedMap& m : graph_.maps) {
    if (!is_placeable(m.map_T_origin)) continue;
    const Vector2 at = frame_(m.map_T_origin.translation());
    svg_ << "<circle class='" << (m.is_active ? "active" : "retired") << "' cx='" << at.x() << "' cy='"
         << at.y() << "' r='" << 4.0 * line_ << "'><title>local map " << m.id
         << (m.is_active ? "" : ", retired") << "</title></circle>\n";
  }
}

/// From the pale to what matters; the chain of odometry over the closures, which are many. An inner <svg>
/// cuts off what leads out of it.
void GraphDrawing::write_map() {
  svg_ << "<svg x='" << kMargin << "' y='" << kMargin << "' width='" << kMapWidth << "' height='"
       << frame_.height << "' viewBox='" << kMargin << ' ' << kMargin << ' ' << kMapWidth << ' '
       << frame_.height << "'>\n";
  write_walls();
  write_path();
  write_loops(graph_.refused, "refused", "refused loop");
  write_closures();
  write_edges(PicturedEdge::Kind::kTurn, "turn", "turn by the IMU");
  write_edges(PicturedEdge::Kind::kOdometry, "odometry", "odometry");
  write_loops(graph_.let_go, "let_go", "closure let go");
  write_nodes();
  svg_ << "</svg>\n";
}

void GraphDrawing::write_scale_bar() {
  const double length_m = round_length(kMapWidth / 4.0 / frame_.px_per_m);
  const double length = length_m * frame_.px_per_m;
  const double y = kMargin + frame_.height + 24.0;
  svg_ << "<path class='scale' d='M" << kMargin << ' ' << y - 6.0 << "v6h" << length << "v-6'/>\n<text x='"
       << kMargin + length + 10.0 << "' y='" << y + 1.0 << "'>" << length_label(length_m) << "</text>\n";
}

void GraphDrawing::write_legend(const std::vector<LegendRow>& rows) {
  constexpr double kCountEnd = 84.0, kLabel = 94.0;
  const double x = kWidth - kMargin - kLegendWidth;
  double y = kMargin + 16.0;
  svg_ << "<text x='" << x << "' y='" << y << "' font-weight='bold'>Pose graph</text>\n";
  for (const LegendRow& row : rows) {
    y += kLegendRow;
    svg_ << "<g transform='translate(" << x << ' ' << y << ")'" << (row.is_detail ? " class='detail'" : "")
         << "><g transform='translate(0 -5)'>" << row.sample << "</g>";
    if (row.count) svg_ << "<text x='" << kCountEnd << "' text-anchor='end'>" << *row.count << "</text>";
    svg_ << "<text x='" << kLabel << "'>" << row.label << "</text></g>\n";
  }
}

std::string GraphDrawing::draw() {
  const std::vector<LegendRow> rows = legend_rows(graph_, left_out());
  const double legend_height = kLegendRow * static_cast<double>(rows.size() + 1);
  begin(2.0 * kMargin + std::max(frame_.height + kScaleRoom, legend_height));
  write_map();
  write_scale_bar();
  write_legend(rows);
  svg_ << "</svg>\n";
  return svg_.text();
}

}  // namespace

std::string to_svg(const GraphPicture& graph, const TrinaryMap& map) {
  return GraphDrawing(graph, map).draw();
}

}  // namespace dynslam
