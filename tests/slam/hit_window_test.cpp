// SPDX-License-Identifier: MIT
#include "slam/hit_window.h"

#include <algorithm>
#include <random>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "slam/byte_search.h"
#include "slam/smooth_hits.h"

namespace dynslam {
namespace {

/// Hits strewn over many chunks, negative ones too.
ChunkedGrid strewn_grid(unsigned seed) {
  std::mt19937 random(seed);
  ChunkedGrid grid(0.02);
  for (int i = 0; i < 4000; ++i) {
    const CellIndex c{static_cast<int>(random() % 500) - 250, static_cast<int>(random() % 500) - 250};
    for (unsigned k = 0; k < 1 + random() % 8; ++k) grid.add_hit(c);
    grid.add_miss({c.x + 3, c.y});
  }
  return grid;
}

std::vector<MatchPoint> some_points() { return {{40, 70, 1}, {-100, 20, 1}, {0, -130, 1}, {150, 5, 1}}; }

TEST(HitWindow, HoldsTheHitsAroundThePointsAcrossSeams) {
  const ChunkedGrid grid = strewn_grid(1);
  const Pose2 at{-20.3, 12.7, 0.3};
  HitWindow window;
  window.load(grid, some_points(), at, 6, 0.02F);
  for (const MatchPoint& p : some_points()) {
    const Vector2 there = at * Vector2(p.x, p.y);
    for (int dy = -8; dy <= 8; ++dy) {
      for (int dx = -8; dx <= 8; ++dx) {
        const CellIndex c{static_cast<int>(std::floor(there.x())) + dx,
                          static_cast<int>(std::floor(there.y())) + dy};
        ASSERT_TRUE(window.contains(c.x - window.first().x, c.y - window.first().y));
        EXPECT_EQ(window.data()[(c.y - window.first().y) * window.stride() + c.x - window.first().x],
                  grid.hit(c));
      }
    }
  }
}

TEST(HitWindow, MultipliesAndMarksTheNeverSeen) {
  const ChunkedGrid grid = strewn_grid(2);
  const std::vector<MatchPoint> points = {{0, 0, 1}};
  HitWindow window;
  window.load(grid, points, {}, 50, 0, 2.5F, 77);
  int seen = 0;
  for (int y = -50; y <= 50; ++y) {
    for (int x = -50; x <= 50; ++x) {
      const int hit = grid.hit({x, y});
      const bool never = hit == 0 && grid.miss({x, y}) == 0;
      const int expected = never ? 77 : std::min(255, hit * 5 / 2);
      const int got = window.data()[(y - window.first().y) * window.stride() + x - window.first().x];
      EXPECT_NEAR(got, expected, never ? 0 : 5) << x << " " << y;
      seen += never ? 0 : 1;
    }
  }
  EXPECT_GT(seen, 100);
}

TEST(HitWindow, PoolsMaxima) {
  const ChunkedGrid grid = strewn_grid(3);
  const std::vector<MatchPoint> points = {{0, 0, 1}, {90, 0, 1}};
  HitWindow fine, coarse;
  fine.load(grid, points, {}, 30, 0);
  coarse.pool(fine);
  for (int y = fine.height() / 2 - 24; y < fine.height() / 2 + 24; ++y) {
    for (int x = -20; x < 20; ++x) {
      const int fx = x - fine.first().x, fy = y;
      const int cx = fx / HitWindow::kPool, cy = fy / HitWindow::kPool;
      int most = 0;
      for (int j = 0; j < HitWindow::kPool; ++j) {
        for (int i = 0; i < HitWindow::kPool; ++i) {
          most = std::max<int>(
              most, fine.data()[(cy * HitWindow::kPool + j) * fine.stride() + cx * HitWindow::kPool + i]);
        }
      }
      if (std::abs(y + fine.first().y) > 24)
        continue;  // only around the points does the window hold anything
      ASSERT_EQ(coarse.data()[cy * coarse.stride() + cx], most) << x << " " << y;
    }
  }
}

TEST(ByteSearch, AgreesWithAddingOneByOne) {
  constexpr std::size_t kStride = 71;
  std::mt19937 random(4);
  std::vector<std::uint8_t> bytes(5000);
  for (auto& b : bytes) b = random() % 3 == 0 ? 255 : static_cast<std::uint8_t>(random());
  for (const std::size_t n : {0U, 1U, 256U, 257U, 258U, 1500U}) {
    std::vector<std::int32_t> offsets(n);
    for (auto& o : offsets) o = static_cast<std::int32_t>(random() % (bytes.size() - 16 - 2 * kStride));
    const auto rows = score_rows<3>(bytes.data(), kStride, offsets);
    for (std::size_t k = 0; k < 3 * 16; ++k) {
      std::uint32_t sum = 0;
      for (const auto o : offsets) sum += bytes[static_cast<std::size_t>(o) + k / 16 * kStride + k % 16];
      EXPECT_EQ(rows[k / 16][k % 16], sum);
    }
    EXPECT_EQ(score_16_shifts(bytes.data(), offsets), rows[0]);
  }
}

TEST(SmoothHits, IsOneOnSureGroundAndFadesOverTwoCells) {
  ChunkedGrid grid(0.02);
  for (int y = -10; y <= 10; ++y) {
    for (int x = -10; x <= 10; ++x) {
      for (int k = 0; k < 10; ++k) grid.add_hit({x, y});
    }
  }
  const std::vector<MatchPoint> points = {{0, 0, 1}};
  HitWindow window;
  window.load(grid, points, {}, 30, 0);
  const auto at = [&](float x, float y) {
    return smooth_hit(window, x - static_cast<float>(window.first().x),
                      y - static_cast<float>(window.first().y));
  };
  EXPECT_NEAR(at(0.3F, -0.7F), 1.0, 1e-5);
  EXPECT_NEAR(at(11.0F, 0.5F), 0.5, 0.01) << "the edge between the last cell with hits and the first without";
  EXPECT_NEAR(at(13.6F, 0.5F), 0.0, 1e-5);
  EXPECT_EQ(at(-1e6F, 0.0F), 0.0F);
  EXPECT_EQ(at(NAN, 0.0F), 0.0F);
}

TEST(SmoothHits, GradientAgreesWithDifferences) {
  const ChunkedGrid grid = strewn_grid(5);
  const std::vector<MatchPoint> points = {{40, 20, 1}, {-30, 25, 0.5F}, {10, -60, 1}, {-44, -13, 1}};
  HitWindow window;
  window.load(grid, points, {}, 20, 0.1F);
  const Pose2 pose{0.3 - window.first().x, -0.2 - window.first().y, 0.05};
  const HitFit fit = fit_to_hits(window, points, pose);
  const double step = 0.05;
  const auto score = [&](double dx, double dy, double dt) {
    return fit_to_hits(window, points, {pose.x + dx, pose.y + dy, pose.yaw + dt}).score;
  };
  EXPECT_NEAR(fit.gradient.x(), (score(step, 0, 0) - score(-step, 0, 0)) / (2 * step), 0.02);
  EXPECT_NEAR(fit.gradient.y(), (score(0, step, 0) - score(0, -step, 0)) / (2 * step), 0.02);
  EXPECT_NEAR(fit.gradient.z(), (score(0, 0, step / 60) - score(0, 0, -step / 60)) / (2 * step / 60), 1.0);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(fit.information);
  EXPECT_GE(eigen.eigenvalues().minCoeff(), -1e-3);
}

}  // namespace
}  // namespace dynslam
