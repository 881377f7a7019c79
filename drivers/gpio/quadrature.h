// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace dynslam {

/// Counts the steps of a quadrature encoder, four to a period: its channels A and B change in turn, and which
/// one leads says the direction. Forward, A leads: 00, 10, 11, 01. A step of both at once is illegal: an edge
/// was lost. So it is when a channel changes to what it is. Neither is a step; both are counted.
class Quadrature {
 public:
  /// The channels as they stand; the first call only takes note of them. Returns the step: -1, 0 or 1.
  int see(bool a, bool b);
  /// One channel changed to `level`. Returns the step.
  int edge(bool of_a, bool level);

  std::int64_t count() const { return count_; }
  std::uint64_t illegal() const { return illegal_; }

 private:
  unsigned state_ = 0;  ///< A and B, as two bits
  bool known_ = false;
  std::int64_t count_ = 0;
  std::uint64_t illegal_ = 0;
};

}  // namespace dynslam
