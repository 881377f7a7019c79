// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "mission_script.h"
#include "sim/random_stream.h"

namespace dynslam {

/// One thing that is asked of the autopilot, until it is done with it.
class Errand {
 public:
  void ask(Ports& ports, const Order& order);
  /// How it stands, once nothing more is to come of it.
  std::shared_ptr<const AutopilotStatus> ended(const Ports& ports) const;

 private:
  std::uint64_t asked_ = 0;
};

/// Explores until all is seen.
class ExploreScript : public MissionScript {
 public:
  std::optional<MissionEnd> turn(Time now, Ports& ports, Simulator& simulator) override;
  /// To ask for more.
  const Errand& errand() const { return errand_; }

 private:
  Errand errand_;
  bool asked_ = false;
};

/// Explores, and then drives to places drawn by lot: nine of ten on the floor that can be reached, the others
/// anywhere.
class GoalsScript : public MissionScript {
 public:
  GoalsScript(std::size_t goals, std::uint64_t seed) : wanted_(goals), random_(seed, kStream) {}

  std::optional<MissionEnd> turn(Time now, Ports& ports, Simulator& simulator) override;
  GoalCounts goals() const override { return counts_; }
  nlohmann::json details() const override;

 private:
  static constexpr std::uint64_t kStream = 0x676f616c;
  struct Goal {
    Destination to;
    std::vector<Vector2> floor_map;  ///< that the robot could drive to when it was asked
    Time since;
  };
  void ask(Time now, Ports& ports, Simulator& simulator);
  Destination draw(const std::vector<Vector2>& floor_map);
  void judge(const Ports& ports, Simulator& simulator, const AutopilotStatus& status);
  void judge_place(const Ports& ports, const AutopilotStatus& status);
  void fail(const std::string& why);

  std::size_t wanted_;
  RandomStream random_;
  ExploreScript exploration_;
  std::optional<MissionEnd> explored_;
  double explored_at_s_ = 0.0;
  Errand errand_;
  std::optional<Goal> goal_;
  std::optional<Time> ended_at_;
  GoalCounts counts_;
  double worst_m_ = 0.0, worst_rad_ = 0.0;
  nlohmann::json failures_ = nlohmann::json::array();
};

}  // namespace dynslam
