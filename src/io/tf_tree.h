// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include <Eigen/Geometry>

namespace dynslam {

/// How the frames of a robot sit on each other, as `/tf_static` tells it. Names may begin with a slash, which
/// does not count (ROS 1 wrote them so).
class TfTree {
 public:
  static constexpr std::size_t kMaxFrames = 1000;

  /// Says where `child` sits; a later word replaces an earlier one. False, and nothing taken, if a name is
  /// empty or longer than 256, both names are the same, the child is 1000 km away or more, the quaternion is
  /// far from unit length, or the tree is full.
  bool add(std::string_view parent, std::string_view child, const Eigen::Vector3d& translation_m,
           const Eigen::Quaterniond& parent_q_child);

  /// `robot_T_frame`, where the robot is `base_link`, else `base_footprint`, else the root that the frame
  /// hangs from. Nothing if the tree does not know the frame, or goes in circles above it.
  std::optional<Eigen::Isometry3d> robot_T(std::string_view frame) const;

  /// How high the frame is above `base_footprint`, metres. Nothing if they do not hang together.
  std::optional<double> height_m(std::string_view frame) const;

 private:
  struct Link {
    std::string parent;
    Eigen::Isometry3d parent_T_child;
  };
  std::optional<Eigen::Isometry3d> chain(std::string_view base, std::string_view frame) const;
  bool is_parent(std::string_view frame) const;
  std::string_view root_of(std::string_view frame) const;

  std::map<std::string, Link, std::less<>> links_;  ///< by child
};

}  // namespace dynslam
