// SPDX-License-Identifier: MIT
#include "drivers/gpio/quadrature.h"

#include <array>
#include <utility>

namespace dynslam {
namespace {

constexpr int kIllegal = 2;
/// The step from one state (row) to the next (column), states as 00, 01, 10, 11.
constexpr std::array<std::array<int, 4>, 4> kSteps = {{
    {0, -1, 1, kIllegal},
    {1, 0, kIllegal, -1},
    {-1, kIllegal, 0, 1},
    {kIllegal, 1, -1, 0},
}};

}  // namespace

int Quadrature::see(bool a, bool b) {
  const unsigned next = (a ? 2U : 0U) | (b ? 1U : 0U);
  const unsigned last = std::exchange(state_, next);
  if (!std::exchange(known_, true)) return 0;
  const int step = kSteps[last][next];
  if (step == kIllegal) {
    ++illegal_;
    return 0;
  }
  count_ += step;
  return step;
}

int Quadrature::edge(bool of_a, bool level) {
  const bool a = (state_ & 2U) != 0, b = (state_ & 1U) != 0;
  if (known_ && level == (of_a ? a : b)) {
    ++illegal_;
    return 0;
  }
  return of_a ? see(level, b) : see(a, level);
}

}  // namespace dynslam
