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

/// People in whose way a door is, again and again: each door that stands open is closed every few minutes,
/// and opened again before long.
class DoorsByLot {
 public:
  explicit DoorsByLot(std::uint64_t seed) : random_(seed, kStream) {}
  void turn(Time now, Simulator& simulator);

 private:
  static constexpr std::uint64_t kStream = 0x646f6f72;
  struct Door {
    std::size_t index = 0;
    double open = 1.0;
    bool closed = false;
    Time moves_at;
  };
  RandomStream random_;
  bool begun_ = false;
  std::vector<Door> doors_;
};

/// A person who helps a robot that touched something: steers it a little back, or forth.
class Helper {
 public:
  /// Returns whether he is at it.
  bool turn(Time now, Ports& ports);
  /// It does not get free.
  bool gave_up() const { return tries_ >= kMostTries; }

 private:
  static constexpr int kMostTries = 4;
  std::optional<Time> since_;
  int tries_ = 0;
};

/// Explores, and then drives to places drawn by lot: nine of ten on the floor that can be reached, the others
/// anywhere. Meanwhile doors close and open.
class GoalsScript : public MissionScript {
 public:
  GoalsScript(std::size_t goals, std::uint64_t seed) : wanted_(goals), random_(seed, kStream), doors_(seed) {}

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
  void judge_place(const Ports& ports, Simulator& simulator, const AutopilotStatus& status);
  void fail(const std::string& why);

  std::size_t wanted_;
  RandomStream random_;
  DoorsByLot doors_;
  Helper helper_;
  ExploreScript exploration_;
  std::optional<MissionEnd> explored_;
  double explored_at_s_ = 0.0;
  Errand errand_;
  std::optional<Goal> goal_;
  std::optional<Time> ended_at_;
  GoalCounts counts_;
  double worst_m_ = 0.0, worst_rad_ = 0.0, worst_true_m_ = 0.0;
  nlohmann::json failures_ = nlohmann::json::array();
};

}  // namespace dynslam
