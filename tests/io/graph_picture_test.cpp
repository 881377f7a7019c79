// SPDX-License-Identifier: MIT
#include "io/graph_picture.h"

#include <limits>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/drawn_map.h"
#include "io/graph_legend.h"
#include "io/svg_text.h"

namespace dynslam {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using Kind = PicturedEdge::Kind;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

std::string name_of(const std::string& tag) { return tag.substr(0, tag.find_first_of(" />")); }

/// What keeps a text from being XML, as far as a look at its tags, entities and bytes tells.
std::optional<std::string> xml_fault(const std::string& text) {
  std::vector<std::string> open;
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1)) {
    const std::size_t end = text.find('>', at);
    if (end == std::string::npos) return "a tag without its end";
    const std::string tag = text.substr(at + 1, end - at - 1);
    if (tag.find('<') != std::string::npos) return "< in a tag: " + tag;
    if (tag.front() != '/') {
      if (tag.back() != '/') open.push_back(name_of(tag));
    } else if (open.empty() || open.back() != tag.substr(1)) {
      return "closes what is not open: " + tag;
    } else {
      open.pop_back();
    }
  }
  if (!open.empty()) return "never closed: " + open.back();
  if (std::regex_search(text, std::regex("&(?!(lt|gt|amp|quot|apos);)"))) return "a bare &";
  return std::nullopt;
}

std::size_t count(const std::string& text, const std::string& piece) {
  std::size_t n = 0;
  for (std::size_t at = text.find(piece); at != std::string::npos; at = text.find(piece, at + 1)) ++n;
  return n;
}

/// Positions of the local maps in the picture, by the words under the mouse.
Vector2 node_at(const std::string& svg, const std::string& words) {
  const std::regex node("cx='([-0-9.]+)' cy='([-0-9.]+)' r='[0-9.]+'><title>" + words + "</title>");
  std::smatch m;
  EXPECT_TRUE(std::regex_search(svg, m, node)) << words;
  return m.empty() ? Vector2(kNan, kNan) : Vector2(std::stod(m[1]), std::stod(m[2]));
}

std::string legend_line(const std::string& count, const std::string& label) {
  return ">" + count + "</text><text x='94'>" + label + "</text>";
}

/// Four maps in a square of 10 m, the path around it, and one of everything.
GraphPicture square() {
  GraphPicture g;
  g.maps = {{0, {0, 0, 0}}, {1, {10, 0, 0}}, {2, {10, 10, 0}}, {3, {0, 10, 0}, false}};
  g.edges = {{Kind::kOdometry, 0, 1, 0.25}, {Kind::kOdometry, 1, 2, 0.5}, {Kind::kOdometry, 2, 3, 0.5},
             {Kind::kTurn, 0, 1, 0.1},      {Kind::kLoop, 0, 3, 1.5},     {Kind::kLoop, 1, 3, 0.5}};
  g.refused = {{0, 2, {10, 8, 0}, "too little overlap"},
               {1, 3, {-10, 8, 0}, "ambiguous"},
               {0, 3, {1, 10, 0}, "ambiguous"}};
  g.let_go = {{0, 2, {5, 5, 0}, "6 sigma off"}};
  g.path_map = {{0, 0}, {10, 0}, {10, 10}, {0, 10}};
  return g;
}

TEST(GraphPicture, ShowsEveryKindOfEdge) {
  const std::string svg = to_svg(square(), drawn_map({"##", "##"}));
  EXPECT_EQ(xml_fault(svg), std::nullopt);
  EXPECT_EQ(count(svg, "<title>odometry "), 3U);
  EXPECT_EQ(count(svg, "<title>closure "), 3U);
  EXPECT_EQ(count(svg, "<title>refused loop "), 3U);
  EXPECT_EQ(count(svg, "<title>local map "), 4U);
  EXPECT_THAT(svg, AllOf(HasSubstr("<title>odometry 0 – 1: 0.25 σ off</title>"),
                         HasSubstr("<title>turn by the IMU 0 – 1: 0.1 σ off</title>"),
                         HasSubstr("<title>closure 0 – 3: 1.5 σ off</title>"),
                         HasSubstr("<title>refused loop 0 – 2: too little overlap</title>"),
                         HasSubstr("<title>closure let go 0 – 2: 6 sigma off</title>"),
                         HasSubstr("<title>local map 3, retired</title>"), HasSubstr("class='walls'"),
                         HasSubstr("class='path' d='M")));
}

TEST(GraphPicture, CountsInTheLegend) {
  const std::string svg = to_svg(square(), {});
  EXPECT_THAT(
      svg,
      AllOf(HasSubstr(legend_line("3", "local maps")), HasSubstr(legend_line("1", "retired local maps")),
            HasSubstr(legend_line("3", "odometry edges")), HasSubstr(legend_line("1", "turns by the IMU")),
            HasSubstr(legend_line("2", "closures")), HasSubstr(legend_line("1", "less than 1 σ off")),
            HasSubstr(legend_line("1", "1 to 2 σ")), HasSubstr(legend_line("0", "3 σ and more")),
            HasSubstr(legend_line("1", "closures let go")), HasSubstr(legend_line("3", "loops refused")),
            HasSubstr(legend_line("2", "ambiguous")), HasSubstr(legend_line("1", "too little overlap"))));
  EXPECT_LT(svg.find(">ambiguous<"), svg.find(">too little overlap</text>")) << "the most frequent first";
  EXPECT_THAT(svg, Not(HasSubstr("left out")));
}

TEST(GraphPicture, PutsTheHighestYOnTop) {
  const std::string svg = to_svg(square(), {});
  const Vector2 origin = node_at(svg, "local map 0"), right = node_at(svg, "local map 1");
  const Vector2 top = node_at(svg, "local map 3, retired");
  EXPECT_GT(right.x(), origin.x() + 300);
  EXPECT_EQ(right.y(), origin.y());
  EXPECT_EQ(top.x(), origin.x());
  EXPECT_LT(top.y(), origin.y() - 300);
}

TEST(GraphPicture, LaysTheWallsUnderTheGraph) {
  GraphPicture g;
  g.maps = {{7, {1.5, 0.5, 0}}};
  const std::string svg = to_svg(g, drawn_map({"# ", " #"}, {0, 0}, 1.0));  // node in the middle of a wall
  std::smatch m;
  ASSERT_TRUE(std::regex_search(
      svg, m, std::regex("translate\\(([0-9.]+) ([0-9.]+)\\) scale\\(([0-9.]+)\\)' d='M0 0.5h1M1 1.5h1'")));
  const Vector2 corner(std::stod(m[1]), std::stod(m[2]));
  const Vector2 wall = corner + std::stod(m[3]) * Vector2(1.5, 1.5);
  EXPECT_LT((node_at(svg, "local map 7") - wall).norm(), 0.02);
}

TEST(GraphPicture, PointsARefusedLoopWhereItWouldHaveLed) {
  GraphPicture g;
  g.maps = {{0, {0, 0, 1.5707963267948966}}, {1, {0, 10, 0}}, {2, {-2, 9, 0}}};
  g.refused = {{0, 1, {9, 2, 0}, "contradicted"}};  // 9 m ahead and 2 m to the left of map 0: on map 2
  const std::string svg = to_svg(g, {});
  SvgText line;
  line << "'M" << node_at(svg, "local map 0") << 'L' << node_at(svg, "local map 2") << "'/><path d='M"
       << node_at(svg, "local map 1") << 'L' << node_at(svg, "local map 2") << "m-3";
  EXPECT_THAT(svg, HasSubstr(line.text()));
}

TEST(GraphPicture, ColoursClosuresByTheirResidual) {
  EXPECT_EQ(closure_band(0.0), 0);
  EXPECT_EQ(closure_band(0.99), 0);
  EXPECT_EQ(closure_band(1.0), 1);
  EXPECT_EQ(closure_band(2.5), 2);
  EXPECT_EQ(closure_band(3.0), 3);
  EXPECT_EQ(closure_band(1e9), 3);
  EXPECT_EQ(closure_band(kNan), 3);
  const std::string svg = to_svg(square(), {});
  EXPECT_LT(svg.find("<path class='closure band0'"), svg.find("<path class='closure band1'"))
      << "the loud over the calm";
}

TEST(GraphPicture, EscapesReasons) {
  GraphPicture g = square();
  g.refused[0].reason = "overlap < 0.3 & \"thin\" 'wall' > \x01\xC3\xA9";
  const std::string svg = to_svg(g, {});
  EXPECT_EQ(xml_fault(svg), std::nullopt);
  EXPECT_EQ(count(svg, "overlap &lt; 0.3 &amp; &quot;thin&quot; &apos;wall&apos; &gt; ?\?\?<"), 2U)
      << "tooltip and legend";
}

TEST(GraphPicture, LeavesOutWhatHasNoPlace) {
  GraphPicture g = square();
  const std::string whole = to_svg(g, {});
  g.maps.push_back({4, {kNan, 0, 0}});
  g.maps.push_back({5, {0, -kInf, 0}});
  g.maps.push_back({6, {0, 1e300, 0}});
  g.edges.push_back({Kind::kOdometry, 3, 4, kNan});
  g.edges.push_back({Kind::kLoop, 0, 99, 0.5});
  g.refused.push_back({0, 2, {kNan, 0, 0}, "nothing found"});
  g.let_go.push_back({5, 2, {}, "far"});
  g.path_map.insert(g.path_map.begin() + 1, {{kNan, 0}, {kInf, kInf}, {-1e300, 0}});
  const std::string svg = to_svg(g, {});
  EXPECT_EQ(xml_fault(svg), std::nullopt);
  EXPECT_THAT(svg, AllOf(Not(HasSubstr("nan")), Not(HasSubstr("inf")), Not(HasSubstr("local map 4"))));
  EXPECT_THAT(svg, HasSubstr(legend_line("7", "left out: no place known")));
  EXPECT_EQ(node_at(svg, "local map 2"), node_at(whole, "local map 2")) << "nor does it move the others";
}

TEST(GraphPicture, BearsAResidualThatIsNoNumber) {
  GraphPicture g = square();
  g.edges[4].residual = kNan;
  const std::string svg = to_svg(g, {});
  EXPECT_THAT(svg, AllOf(HasSubstr("closure 0 – 3: not known how far off"), Not(HasSubstr("nan"))));
}

TEST(GraphPicture, IsSmallAndWholeWithoutAGraph) {
  const std::string svg = to_svg({}, {});
  EXPECT_EQ(xml_fault(svg), std::nullopt);
  EXPECT_LT(svg.size(), 5000U);
  EXPECT_THAT(svg, AllOf(HasSubstr("<svg "), HasSubstr(legend_line("0", "local maps")), HasSubstr("scale")));
}

TEST(GraphPicture, OfASingleMapIsNoLargerThanItNeedsToBe) {
  GraphPicture g;
  g.maps = {{0, {123, -45, 0.5}}};
  const std::string svg = to_svg(g, {});
  EXPECT_EQ(xml_fault(svg), std::nullopt);
  EXPECT_EQ(node_at(svg, "local map 0"), Vector2(455, 120)) << "the middle of the map's part";
}

TEST(GraphPicture, DoesNotShrinkTheBuildingForALoopToFarAway) {
  GraphPicture g = square();
  const Vector2 before = node_at(to_svg(g, {}), "local map 2");
  g.refused.push_back({0, 2, {5e4, 5e4, 0}, "contradicted"});
  EXPECT_EQ(node_at(to_svg(g, {}), "local map 2"), before);
}

TEST(GraphPicture, KeepsTheLegendShortWhateverTheReasons) {
  GraphPicture g = square();
  for (int i = 0; i < 500; ++i) g.refused.push_back({0, 1, {}, "reason " + std::to_string(i)});
  const std::string svg = to_svg(g, {});
  EXPECT_THAT(svg, AllOf(HasSubstr(legend_line("503", "loops refused")),
                         HasSubstr(legend_line("490", "other reasons"))));
}

TEST(GraphPicture, SkipsStepsOfThePathThatCannotBeSeen) {
  GraphPicture g = square();
  const std::string once = to_svg(g, {});
  g.path_map.insert(g.path_map.end(), 1000, g.path_map.back());
  EXPECT_EQ(to_svg(g, {}), once);
}

TEST(GraphPicture, OfALargeBuildingStaysSmall) {
  TrinaryMap map;  // 40 m by 40 m with a wall each metre, both ways
  map.width = map.height = 2000;
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      const bool is_wall = column % 50 < 3 || row % 50 < 3;
      map.cells.push_back(is_wall ? CellState::kOccupied : CellState::kFree);
    }
  }
  EXPECT_LT(to_svg({}, map).size(), 500'000U);
}

TEST(SvgText, WritesShortNumbers) {
  SvgText text;
  text << 1.0 << ' ' << 0.125 << ' ' << -0.001 << ' ' << 100.0 << ' ' << 12.5 << ' ' << -3 << ' '
       << Vector2(1.25, -2.0);
  EXPECT_EQ(text.text(), "1 0.12 0 100 12.5 -3 1.25 -2");
}

}  // namespace
}  // namespace dynslam
