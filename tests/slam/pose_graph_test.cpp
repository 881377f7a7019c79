// SPDX-License-Identifier: MIT
#include "slam/pose_graph.h"

#include <algorithm>
#include <limits>
#include <random>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <ceres/autodiff_cost_function.h>
#include <gtest/gtest.h>

#include "slam/relative_pose_cost.h"
#include "support_matchers.h"

namespace dynslam {
namespace {

Eigen::Matrix3d sigmas(double metres, double angle_rad) {
  return Eigen::Vector3d(metres * metres, metres * metres, angle_rad * angle_rad).asDiagonal();
}
const Eigen::Matrix3d kOdometry = sigmas(0.05, 0.01);
const Eigen::Matrix3d kLoop = sigmas(0.03, 0.005);

/// Seeded noise, the same with every standard library.
class Noise {
 public:
  explicit Noise(unsigned seed) : random_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) / 4294967295.0;
  }
  double normal() {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += uniform(0, 1);
    return sum;
  }
  Pose2 pose(double reach_m) {
    return {uniform(-reach_m, reach_m), uniform(-reach_m, reach_m), uniform(-kPi, kPi)};
  }
  Pose2 on(const Pose2& p, const Eigen::Matrix3d& covariance) {
    const Eigen::Vector3d s = covariance.diagonal().cwiseSqrt();
    return {p.x + s(0) * normal(), p.y + s(1) * normal(), wrap_angle(p.yaw + s(2) * normal())};
  }
  std::uint32_t index(std::size_t n) { return static_cast<std::uint32_t>(random_() % n); }

 private:
  std::mt19937 random_;
};

/// A full covariance with correlations.
Eigen::Matrix3d some_covariance(Noise& noise) {
  Eigen::Matrix3d root = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < i; ++k) root(i, k) = noise.uniform(-0.05, 0.05);
    root(i, i) = noise.uniform(0.02, 0.1);
  }
  return root * root.transpose();
}

/// A drive round and round a rectangle of 40 x 20 m, a node every 2 m, 60 a lap.
std::vector<Pose2> laps(std::size_t nodes) {
  std::vector<Pose2> map_T_node;
  for (std::size_t i = 0; i < nodes; ++i) {
    const double u = 2.0 * static_cast<double>(i % 60), out = 0.3 * static_cast<double>(i / 60);
    if (u < 40) {
      map_T_node.push_back({u, out, 0});
    } else if (u < 60) {
      map_T_node.push_back({40 + out, u - 40, kPi / 2});
    } else if (u < 100) {
      map_T_node.push_back({100 - u, 20 + out, kPi});
    } else {
      map_T_node.push_back({out, 120 - u, -kPi / 2});
    }
  }
  return map_T_node;
}

struct Drive {
  std::vector<Pose2> truth;
  PoseGraph graph;
  Noise noise;

  /// A drive with noisy odometry, poses as odometry has them.
  Drive(std::size_t nodes, unsigned seed, double noise_factor = 1, const Pose2& map_T_start = {})
      : truth(laps(nodes)), noise(seed) {
    Pose2 at = map_T_start;
    graph.add_node(0, at);
    for (std::uint32_t i = 1; i < nodes; ++i) {
      const Pose2 step = noise.on(between(i - 1, i), noise_factor * noise_factor * kOdometry);
      at = at * step;
      graph.add_node(i, at);
      graph.add_odometry_edge(i - 1, i, step, kOdometry);
    }
  }
  Pose2 between(std::size_t a, std::size_t b) const { return truth[a].inverse() * truth[b]; }
  void add_right_loop(std::uint32_t a, std::uint32_t b) {
    graph.add_loop_edge(a, b, noise.on(between(a, b), kLoop), kLoop);
  }
  void add_right_loops(int count) {
    for (int k = 0; k < count;) {
      const std::uint32_t a = noise.index(truth.size()), b = noise.index(truth.size());
      if (a + 10 > b || between(a, b).translation().norm() > 5) continue;
      add_right_loop(a, b);
      ++k;
    }
  }
  double rms_m() const {
    double sum = 0;
    for (const GraphNode& n : graph.nodes())
      sum += (n.map_T_node.translation() - truth[n.id].translation()).squaredNorm();
    return std::sqrt(sum / static_cast<double>(graph.nodes().size()));
  }
};

double farthest_apart(const PoseGraph& a, const PoseGraph& b, const Pose2& shift = {}) {
  double most = 0;
  for (const GraphNode& n : a.nodes()) {
    const Pose2 off = (shift * n.map_T_node).inverse() * b.pose(n.id);
    most = std::max({most, off.translation().norm(), std::abs(off.yaw)});
  }
  return most;
}

/// The residual once more, written for automatic differentiation.
struct PlainResidual {
  Pose2 a_T_b;
  Eigen::Matrix3d whitening;

  template <class T>
  bool operator()(const T* a, const T* b, T* out) const {
    using std::atan2, std::cos, std::sin;
    const T c = cos(a[2]), s = sin(a[2]);
    const T turned = b[2] - a[2] - a_T_b.yaw;
    Eigen::Map<Eigen::Matrix<T, 3, 1>>{out} =
        whitening.cast<T>() * Eigen::Matrix<T, 3, 1>(c * (b[0] - a[0]) + s * (b[1] - a[1]) - a_T_b.x,
                                                     c * (b[1] - a[1]) - s * (b[0] - a[0]) - a_T_b.y,
                                                     atan2(sin(turned), cos(turned)));
    return true;
  }
};

TEST(RelativePoseCost, HasTheJacobianOfItsResidual) {
  Noise noise(1);
  for (int i = 0; i < 100; ++i) {
    Pose2 a = noise.pose(20), b = noise.pose(20);
    if (i % 3 == 0) a.yaw = kPi - 1e-4 * i;
    if (i % 5 == 0) b.yaw = -kPi + 1e-4 * i;
    const Pose2 a_T_b = i % 2 == 0 ? noise.pose(20) : noise.on(a.inverse() * b, kOdometry);
    const Eigen::Matrix3d whitening = some_covariance(noise).inverse();
    const RelativePoseCost analytic(a_T_b, whitening);
    const ceres::AutoDiffCostFunction<PlainResidual, 3, 3, 3> automatic(new PlainResidual{a_T_b, whitening});
    const double blocks[2][3] = {{a.x, a.y, a.yaw}, {b.x, b.y, b.yaw}};
    const double* poses[2] = {blocks[0], blocks[1]};
    double got[3][9], expected[3][9];  // residual, then the two Jacobians
    double *got_jacobians[2] = {got[1], got[2]}, *expected_jacobians[2] = {expected[1], expected[2]};
    ASSERT_TRUE(analytic.Evaluate(poses, got[0], got_jacobians));
    ASSERT_TRUE(automatic.Evaluate(poses, expected[0], expected_jacobians));
    const double scale = whitening.norm() * 40;
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(got[0][k], expected[0][k], 1e-12 * scale) << i;
    for (int k = 0; k < 9; ++k) EXPECT_NEAR(got[1][k], expected[1][k], 1e-12 * scale) << i;
    for (int k = 0; k < 9; ++k) EXPECT_NEAR(got[2][k], expected[2][k], 1e-12 * scale) << i;
  }
}

TEST(TurnCost, CountsTheTurnTheShortWay) {
  const TurnCost cost(3.1, 10);
  const double a[3] = {1, 2, 0.05}, b[3] = {3, 4, -3.1};
  const double* poses[2] = {a, b};
  double residual = 0, by_a[3], by_b[3];
  double* jacobians[2] = {by_a, by_b};
  ASSERT_TRUE(cost.Evaluate(poses, &residual, jacobians));
  EXPECT_NEAR(residual, 10 * (kTwoPi - 3.1 - 0.05 - 3.1), 1e-12);
  EXPECT_THAT(by_a, testing::ElementsAre(0, 0, -10));
  EXPECT_THAT(by_b, testing::ElementsAre(0, 0, 10));
}

TEST(RelativePose, CarriesCovariancesAlong) {
  Noise noise(2);
  const RelativePose a_T_b{noise.pose(5), 1e-4 * some_covariance(noise)};
  const RelativePose b_T_c{noise.pose(5), 1e-4 * some_covariance(noise)};
  const Eigen::Matrix3d root_ab = a_T_b.covariance.llt().matrixL(),
                        root_bc = b_T_c.covariance.llt().matrixL();
  const auto drawn = [&](const Pose2& p, const Eigen::Matrix3d& root) {
    const Eigen::Vector3d e = root * Eigen::Vector3d(noise.normal(), noise.normal(), noise.normal());
    return Pose2{p.x + e(0), p.y + e(1), wrap_angle(p.yaw + e(2))};
  };
  const RelativePose back = inverse(a_T_b * b_T_c);
  Eigen::Matrix3d sampled = Eigen::Matrix3d::Zero();
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    const Pose2 p = (drawn(a_T_b.pose, root_ab) * drawn(b_T_c.pose, root_bc)).inverse();
    const Eigen::Vector3d e(p.x - back.pose.x, p.y - back.pose.y, turn(back.pose.yaw, p.yaw));
    sampled += e * e.transpose() / kSamples;
  }
  EXPECT_LT((sampled - back.covariance).norm(), 0.03 * back.covariance.norm());
}

TEST(PoseGraph, ClosesASquareWithOneLoop) {
  PoseGraph graph;
  const Pose2 step{4, 0, kPi / 2}, drifting{4.02, 0.03, kPi / 2 + 0.01};
  Pose2 at;
  graph.add_node(0, at);
  for (std::uint32_t i = 1; i <= 4; ++i) {
    graph.add_node(i, at = at * drifting);
    graph.add_odometry_edge(i - 1, i, drifting, kOdometry);
  }
  EXPECT_GT(at.translation().norm(), 0.1);
  graph.add_loop_edge(0, 4, Pose2{}, sigmas(0.001, 0.001));
  const PoseGraphSummary summary = graph.solve();
  EXPECT_TRUE(summary.solved);
  EXPECT_LT(summary.cost_after, summary.cost_before);
  EXPECT_EQ(graph.pose(0), Pose2{}) << "held fixed";
  EXPECT_THAT(graph.pose(4), PoseNear(Pose2{}, 0.002, 0.001));
  EXPECT_THAT(graph.pose(2), PoseNear(step * step, 0.06, 0.01));
}

TEST(PoseGraph, SolvesALongNoisyDrive) {
  double all_before = 0, all_after = 0;
  for (unsigned seed = 0; seed < 10; ++seed) {
    Drive drive(200, seed);
    const double before = drive.rms_m();
    drive.add_right_loops(60);
    const PoseGraphSummary summary = drive.graph.solve();
    EXPECT_TRUE(summary.solved);
    EXPECT_LE(summary.let_go.size(), 1U) << seed;
    EXPECT_LT(drive.rms_m(), before / 2) << seed;
    // 3 * (199 + 60) residuals less 3 * 199 unknowns: chi-squared with 180 degrees of freedom, 4 sigmas.
    EXPECT_NEAR(2 * summary.cost_after, 180, 75) << seed;
    all_before += before;
    all_after += drive.rms_m();
  }
  EXPECT_LT(all_after, all_before / 5);
}

TEST(PoseGraph, LetsWrongLoopsGo) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    Drive drive(200, seed);
    drive.add_right_loops(40);
    PoseGraph without = drive.graph;
    without.solve();
    drive.graph.add_loop_edge(10, 100, Pose2{0.5, 0.2, 0.1}, kLoop);
    drive.graph.add_loop_edge(33, 150, drive.between(33, 150) * Pose2{2, -1.5, 0}, kLoop);
    const PoseGraphSummary summary = drive.graph.solve();
    EXPECT_EQ(drive.graph.loops_let_go(), without.loops_let_go() + 2) << seed;
    EXPECT_EQ(summary.let_go.size(), drive.graph.loops_let_go());
    EXPECT_LT(farthest_apart(without, drive.graph), 0.005) << seed;
  }
}

TEST(PoseGraph, LetsTwoWrongLoopsGoThatAgree) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    Drive drive(200, seed);
    drive.add_right_loops(40);
    PoseGraph without = drive.graph;
    without.solve();
    const Pose2 mistaken{6, 0, 0};  // one corridor door taken for another
    drive.graph.add_loop_edge(20, 141, drive.between(20, 141) * mistaken, kLoop);
    drive.graph.add_loop_edge(21, 142, drive.between(21, 142) * mistaken, kLoop);
    drive.graph.solve();
    EXPECT_EQ(drive.graph.loops_let_go(), without.loops_let_go() + 2) << seed;
    EXPECT_LT(farthest_apart(without, drive.graph), 0.005) << seed;
  }
}

TEST(PoseGraph, BelievesOdometryOverALoneLoopFarOut) {
  Drive drive(60, 3);
  const PoseGraph before = drive.graph;
  drive.graph.add_loop_edge(0, 59, drive.between(0, 59) * Pose2{0, 15, 0}, kLoop);
  EXPECT_EQ(drive.graph.solve().let_go.size(), 1U);
  EXPECT_LT(farthest_apart(before, drive.graph), 1e-3);
}

TEST(PoseGraph, UsesTurnsOfTheImu) {
  Drive drive(60, 4, 3);
  const double before = drive.rms_m();
  for (std::uint32_t i = 1; i < 60; ++i)
    drive.graph.add_turn_edge(i - 1, i, drive.between(i - 1, i).yaw, 0.001);
  drive.graph.solve();
  EXPECT_LT(std::abs(turn(drive.truth[59].yaw, drive.graph.pose(59).yaw)), 0.005);
  EXPECT_LT(drive.rms_m(), before / 2);
}

TEST(PoseGraph, TurnsTheShortWayAtTheSeam) {
  PoseGraph graph;
  graph.add_node(7, {0, 0, 3.1});
  graph.add_node(8, {1, 0, -3.1});
  graph.add_odometry_edge(7, 8, {-1, 0, 0.1}, kOdometry);
  graph.solve();
  EXPECT_THAT(graph.pose(8), PoseNear(Pose2{0, 0, 3.1} * Pose2{-1, 0, 0.1}, 1e-6, 1e-6));
  EXPECT_LE(std::abs(graph.pose(8).yaw), kPi);
}

TEST(PoseGraph, LeavesWhatNothingTiesWhereItIs) {
  Drive drive(20, 5);
  PoseGraph& graph = drive.graph;
  graph.add_node(100, {5, 5, 1});
  graph.add_node(200, {7, 7, 1});
  graph.add_node(201, {8, 7, 1});
  graph.add_odometry_edge(200, 201, {2, 0, 0}, kOdometry);
  EXPECT_TRUE(graph.solve().solved);
  EXPECT_EQ(graph.pose(100), (Pose2{5, 5, 1}));
  EXPECT_EQ(graph.pose(200), (Pose2{7, 7, 1}));
  EXPECT_THAT(graph.pose(201), PoseNear(Pose2{7, 7, 1} * Pose2{2, 0, 0}, 1e-6, 1e-6));
  EXPECT_FALSE(graph.relative_covariance(0, 100));
  EXPECT_TRUE(PoseGraph().solve().solved) << "an empty graph";
}

TEST(PoseGraph, RefusesWhatCannotBe) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  PoseGraph graph;
  EXPECT_TRUE(graph.add_node(1, {}));
  EXPECT_TRUE(graph.add_node(2, {1, 0, 0}));
  EXPECT_FALSE(graph.add_node(2, {2, 0, 0}));
  EXPECT_FALSE(graph.add_node(3, {kNan, 0, 0}));
  EXPECT_FALSE(graph.add_odometry_edge(1, 3, {}, kOdometry));
  EXPECT_FALSE(graph.add_odometry_edge(1, 1, {}, kOdometry));
  EXPECT_FALSE(graph.add_odometry_edge(1, 2, {0, kNan, 0}, kOdometry));
  EXPECT_FALSE(graph.add_loop_edge(1, 2, {}, kNan * kLoop));
  EXPECT_FALSE(graph.add_loop_edge(2, 1, {}, Eigen::Matrix3d::Zero()));
  EXPECT_FALSE(graph.add_loop_edge(1, 2, {}, -kLoop));
  EXPECT_FALSE(graph.add_turn_edge(1, 2, 0, 0));
  EXPECT_FALSE(graph.add_turn_edge(1, 2, 0, kNan));
  EXPECT_EQ(graph.refused(), 10U);
  EXPECT_TRUE(graph.edges().empty());
  EXPECT_EQ(graph.pose(2), (Pose2{1, 0, 0}));
}

TEST(PoseGraph, KeepsThePosesWhenTheSolverGivesUp) {
  PoseGraph graph;
  graph.add_node(1, {});
  graph.add_node(2, {1e308, 0, 0});
  graph.add_odometry_edge(1, 2, {0, 0, 0}, kOdometry);
  EXPECT_FALSE(graph.solve().solved) << "its residual is not finite";
  EXPECT_EQ(graph.pose(2), (Pose2{1e308, 0, 0}));
}

TEST(PoseGraph, KeepsTheSurestEdgeOfAPair) {
  PoseGraph graph;
  graph.add_node(1, {});
  graph.add_node(2, {1, 0, 0});
  graph.add_odometry_edge(1, 2, {1.5, 0, 0}, kOdometry);
  graph.add_odometry_edge(2, 1, Pose2{2, 0, 1}.inverse(), 0.1 * kOdometry);
  graph.add_odometry_edge(1, 2, {1, 1, 1}, 2 * kOdometry);
  EXPECT_EQ(graph.edges().size(), 1U);
  graph.solve();
  EXPECT_THAT(graph.pose(2), PoseNear(Pose2{2, 0, 1}, 1e-6, 1e-6));
}

TEST(PoseGraph, KnowsHowWellRelativePosesAreKnown) {
  Drive drive(60, 6);
  const double far = drive.graph.relative_covariance(0, 59)->trace();
  EXPECT_GT(far, 59 * kOdometry.trace()) << "turns move what is far";
  EXPECT_EQ(*drive.graph.relative_covariance(5, 5), Eigen::Matrix3d::Zero());
  drive.add_right_loop(1, 58);
  EXPECT_LT(drive.graph.relative_covariance(0, 59)->trace(), far / 10);
  EXPECT_EQ(drive.graph.relatives_of(30).size(), 60U);
}

TEST(PoseGraph, KeepsPosesWhenANodeRetires) {
  Drive drive(120, 7);
  drive.add_right_loops(40);
  drive.graph.solve();
  const PoseGraph before = drive.graph;
  for (std::uint32_t id = 3; id < 120; id += 4) EXPECT_TRUE(drive.graph.retire(id));
  EXPECT_FALSE(drive.graph.retire(3)) << "it is gone";
  EXPECT_TRUE(drive.graph.solve().solved);
  EXPECT_EQ(drive.graph.nodes().size(), 90U);
  EXPECT_EQ(drive.graph.relatives_of(0).size(), 90U) << "all still tied together";
  EXPECT_LT(farthest_apart(drive.graph, before), 0.15);
  EXPECT_LT(drive.rms_m(), 0.35);
}

TEST(PoseGraph, HoldsTheNextOldestWhenTheFirstRetires) {
  Drive drive(30, 8);
  drive.graph.retire(0);
  const Pose2 held = drive.graph.pose(1);
  drive.graph.add_loop_edge(1, 29, drive.between(1, 29), kLoop);
  drive.graph.solve();
  EXPECT_EQ(drive.graph.pose(1), held);
  for (std::uint32_t id = 1; id < 30; ++id) drive.graph.retire(id);
  EXPECT_TRUE(drive.graph.nodes().empty());
  EXPECT_TRUE(drive.graph.edges().empty());
}

TEST(PoseGraph, StaysSmallOverManyLaps) {
  Drive drive(60, 9);
  drive.truth = laps(1500);
  for (std::uint32_t i = 60; i < 1500; ++i) {
    const Pose2 step = drive.noise.on(drive.between(i - 1, i), kOdometry);
    drive.graph.add_node(i, drive.graph.pose(i - 1) * step);
    drive.graph.add_odometry_edge(i - 1, i, step, kOdometry);
    drive.graph.add_turn_edge(i - 1, i, step.yaw, 0.02);
    for (const std::uint32_t old : {i - 58, i - 57}) {
      if (drive.graph.has(old)) drive.add_right_loop(old, i);
    }
    if (i % 20 == 0) {
      EXPECT_TRUE(drive.graph.solve().solved);
    }
    drive.graph.retire(i % 7 == 0 ? i - 1 : i - 59);  // mostly the oldest, but also others
  }
  EXPECT_LE(drive.graph.nodes().size(), 300U);
  EXPECT_LE(drive.graph.edges().size(), (16 + 2) * drive.graph.nodes().size());
  EXPECT_EQ(drive.graph.relatives_of(1499).size(), drive.graph.nodes().size()) << "all tied together";
  EXPECT_EQ(drive.graph.refused(), 0U);
}

TEST(PoseGraph, GivesTheSameBits) {
  Drive one(200, 11), other(200, 11);
  for (Drive* d : {&one, &other}) {
    d->add_right_loops(50);
    d->graph.add_loop_edge(10, 100, Pose2{0.5, 0.2, 0.1}, kLoop);
    d->graph.solve();
    d->graph.retire(17);
    d->graph.solve();
  }
  for (const GraphNode& n : one.graph.nodes()) EXPECT_EQ(n.map_T_node, other.graph.pose(n.id));
}

TEST(PoseGraph, GivesTheSameAnswerWhereverTheMapLies) {
  const Pose2 shift{30, -70, 2.5};
  Drive here(200, 12), there(200, 12, 1, shift);
  for (Drive* d : {&here, &there}) {
    d->add_right_loops(50);
    d->graph.solve();
  }
  EXPECT_LT(farthest_apart(here.graph, there.graph, shift), 1e-3);
}

}  // namespace
}  // namespace dynslam
