// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "sim/surface.h"

namespace dynslam {

/// Whatever moves by itself: doors, people, furniture that is pushed about. None of it runs into the robot:
/// doors and furniture wait, people stop, and turn back when they have waited for long.
class Actors {
 public:
  explicit Actors(const World& world);

  /// Moves everything on by `dt_s` to the time `now_s`. Says whether anything moved.
  bool step(double now_s, double dt_s, const Pose2& world_T_robot);
  /// All their faces where they are now. Their part ids begin where those of fixed_surfaces end.
  std::vector<Surface> surfaces() const;
  bool is_of_person(const Surface& surface) const;

  /// From now on, in place of what the world's schedule says. REQUIRES: there is such a door.
  void move_door(std::size_t door, double open) { doors_[door].told = open; }

  /// Points that none of their faces ever goes beyond.
  static std::vector<Vector2> reach(const World& world);

 private:
  struct DoorState {
    Door door;
    double open;
    std::optional<double> told;  ///< to be open so far, whatever its schedule says

    std::pair<Vector2, Vector2> leaf(double share) const;
  };
  struct PersonState {
    Person person;
    Vector2 at;
    double heading_rad = 0.0;
    std::size_t target = 1;
    bool backwards = false;
    double walked_m = 0.0;
    double pause_left_s = 0.0;
    double waited_s = 0.0;
  };
  struct FurnitureState {
    Furniture thing;
    Pose2 world_T_thing;
    Pose2 moved_from;
    std::size_t next_move = 0;
    double move_share = 0.0;
  };

  bool step_door(DoorState& state, double now_s, double dt_s, const Pose2& world_T_robot) const;
  bool step_person(PersonState& state, double now_s, double dt_s, const Pose2& world_T_robot) const;
  bool step_furniture(FurnitureState& state, double now_s, double dt_s, const Pose2& world_T_robot) const;
  static void turn_to_next_point(PersonState& state);
  bool may_walk_to(const PersonState& state, const Vector2& next, const Pose2& world_T_robot) const;

  std::vector<DoorState> doors_;
  std::vector<PersonState> people_;
  std::vector<FurnitureState> furniture_;
  int first_part_ = 0;
  std::optional<Pose2> world_T_robot_;  ///< at the last step
  Pose2 world_T_robot_soon_;            ///< if it drives on like this
};

}  // namespace dynslam
