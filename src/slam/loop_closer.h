// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/counters.h"
#include "slam/finished_map.h"
#include "slam/loop_search.h"
#include "slam/pose_graph.h"

namespace dynslam {

/// A loop that was found and is not believed, for the picture of the graph.
struct RefusedLoop {
  std::uint32_t a = 0, b = 0;
  Pose2 a_T_b;  ///< where it would have put b; meaningless when nothing was found
  std::string reason;
};

/// Whether a relative pose is so little known that no measurement could contradict it: between maps from
/// before and after the robot was lost.
bool is_anyones_guess(const Eigen::Matrix3d& covariance);

/// Looks for places seen before and decides which loops become constraints: those that the match itself
/// supports (see refusal()) and that agree with what the graph allows; or, where they do not, that agree with
/// each other: odometry may have slipped, but several loops from several places do not ask for the same
/// correction by chance. One thread.
class LoopCloser {
 public:
  explicit LoopCloser(PoseGraph& graph) : graph_(graph) {}

  /// Puts in the newest map, whose node is in the graph, and closes its loops with those before. Returns
  /// whether constraints were added.
  bool close(std::shared_ptr<const FinishedMap> map);
  /// Puts in a map without looking for anything.
  void know(std::shared_ptr<const FinishedMap> map);
  /// Forgets a map that was retired.
  void forget(std::uint32_t id);
  /// Forgets the loops that are not believed of maps older than this one, unless they are still known.
  void forget_refused_before(std::uint32_t id);

  std::uint64_t closures() const { return closures_; }
  const Counters& counters() const { return counters_; }
  /// Notes constraints that the graph let go.
  void note_let_go(const std::vector<GraphEdge>& edges);
  /// The last few hundred loops that were never believed, and those that were until the graph let them go;
  /// oldest first.
  const std::deque<RefusedLoop>& refused() const { return refused_; }
  const std::deque<RefusedLoop>& let_go() const { return let_go_; }

 private:
  struct Known {
    std::shared_ptr<const FinishedMap> map;
    double reach_m = 0.0;  ///< of its farthest surface from its origin
  };
  struct Candidate {
    std::uint32_t id = 0;
    RelativePose target_T_source;  ///< as the graph has it
    double share = 0.0;            ///< of the source's points of which the target knows something
    double worth = 0.0;
  };
  /// A loop that contradicts the graph and waits for others that say the same.
  struct Claim {
    std::uint32_t a = 0, b = 0;
    RelativePose a_T_b;
  };

  std::vector<Candidate> candidates(const Known& source) const;
  void try_loop(const FinishedMap& source, const Candidate& candidate, const SearchWindow& window);
  void look_about(const FinishedMap& source, const std::vector<Candidate>& candidates);
  void hear_claim(const Claim& claim);
  void add(const Claim& claim);
  void refuse(const Claim& claim, std::string_view why);

  PoseGraph& graph_;
  std::map<std::uint32_t, Known> maps_;
  std::deque<Claim> claims_;
  std::deque<RefusedLoop> refused_, let_go_;
  std::uint64_t closures_ = 0;
  Counters counters_;
};

}  // namespace dynslam
