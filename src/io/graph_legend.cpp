// SPDX-License-Identifier: MIT
#include "io/graph_legend.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "io/svg_text.h"

namespace dynslam {
namespace {

constexpr std::size_t kMostReasons = 12;

std::string line_sample(const std::string& kind) { return "<path class='" + kind + "' d='M0 0h34'/>"; }

std::string node_sample(const std::string& kind) {
  return "<circle class='" + kind + "' cx='17' cy='0' r='4'/>";
}

std::string loop_sample(const std::string& kind) {
  return "<g class='" + kind + "'><path class='dashed' d='M0 0h28'/><path d='M25 -3l6 6m0 -6l-6 6'/></g>";
}

std::size_t count_edges(const GraphPicture& graph, PicturedEdge::Kind kind) {
  return static_cast<std::size_t>(std::count_if(graph.edges.begin(), graph.edges.end(),
                                                [&](const PicturedEdge& e) { return e.kind == kind; }));
}

void append_maps(const GraphPicture& graph, std::vector<LegendRow>& rows) {
  const auto active = static_cast<std::size_t>(
      std::count_if(graph.maps.begin(), graph.maps.end(), [](const PicturedMap& m) { return m.is_active; }));
  const std::size_t retired = graph.maps.size() - active;
  rows.push_back({node_sample("active"), active, "local maps"});
  if (retired > 0) rows.push_back({node_sample("retired"), retired, "retired local maps"});
}

void append_closures(const GraphPicture& graph, std::vector<LegendRow>& rows) {
  std::array<std::size_t, kClosureBands> counts{};
  for (const PicturedEdge& e : graph.edges) {
    if (e.kind == PicturedEdge::Kind::kLoop) ++counts[static_cast<std::size_t>(closure_band(e.residual))];
  }
  const char* const labels[kClosureBands] = {"less than 1 σ off", "1 to 2 σ", "2 to 3 σ", "3 σ and more"};
  rows.push_back({"", count_edges(graph, PicturedEdge::Kind::kLoop), "closures"});
  for (int band = 0; band < kClosureBands; ++band) {
    const auto i = static_cast<std::size_t>(band);
    rows.push_back({line_sample("closure band" + std::to_string(band)), counts[i], labels[i], true});
  }
}

/// The most frequent reasons, one a row, and the others together.
void append_reasons(const std::vector<PicturedLoop>& loops, std::vector<LegendRow>& rows) {
  std::map<std::string, std::size_t> counts;
  for (const PicturedLoop& loop : loops) ++counts[loop.reason];
  std::vector<std::pair<std::string, std::size_t>> sorted(counts.begin(), counts.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  std::size_t others = 0;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const auto& [reason, count] = sorted[i];
    if (i < kMostReasons) {
      rows.push_back({"", count, reason.empty() ? "no reason given" : xml_text(reason), true});
    } else {
      others += count;
    }
  }
  if (others > 0) rows.push_back({"", others, "other reasons", true});
}

}  // namespace

int closure_band(double residual) {
  for (int band = 0; band + 1 < kClosureBands; ++band) {
    if (residual < band + 1) return band;
  }
  return kClosureBands - 1;
}

std::vector<LegendRow> legend_rows(const GraphPicture& graph, std::size_t left_out) {
  std::vector<LegendRow> rows;
  append_maps(graph, rows);
  rows.push_back(
      {line_sample("odometry"), count_edges(graph, PicturedEdge::Kind::kOdometry), "odometry edges"});
  const std::size_t turns = count_edges(graph, PicturedEdge::Kind::kTurn);
  if (turns > 0) rows.push_back({line_sample("turn"), turns, "turns by the IMU"});
  append_closures(graph, rows);
  if (!graph.let_go.empty()) rows.push_back({loop_sample("let_go"), graph.let_go.size(), "closures let go"});
  rows.push_back({loop_sample("refused"), graph.refused.size(), "loops refused"});
  append_reasons(graph.refused, rows);
  rows.push_back({line_sample("path"), std::nullopt, "the robot's path"});
  if (left_out > 0) rows.push_back({"", left_out, "left out: no place known"});
  return rows;
}

}  // namespace dynslam
