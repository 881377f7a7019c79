// SPDX-License-Identifier: MIT
#include "io/tf_tree.h"

#include <algorithm>
#include <cmath>

namespace dynslam {
namespace {

constexpr std::size_t kMaxNameLength = 256;
constexpr double kUnitTolerance = 0.1;
constexpr double kReach = 5.0;  // metres: no part of a small robot is farther from another

std::string_view without_slash(std::string_view name) {
  if (!name.empty() && name.front() == '/') name.remove_prefix(1);
  return name;
}

bool is_name(std::string_view name) { return !name.empty() && name.size() <= kMaxNameLength; }

}  // namespace

bool TfTree::add(std::string_view parent, std::string_view child, const Eigen::Vector3d& translation_m,
                 const Eigen::Quaterniond& parent_q_child) {
  parent = without_slash(parent);
  child = without_slash(child);
  const bool is_unit = std::abs(parent_q_child.norm() - 1.0) <= kUnitTolerance;  // false for NaN
  const bool is_near = translation_m.norm() < kReach;                            // so is this
  if (!is_name(parent) || !is_name(child) || parent == child || !is_near || !is_unit) return false;
  if (links_.size() >= kMaxFrames && !links_.contains(child)) return false;
  const Eigen::Isometry3d parent_T_child = Eigen::Translation3d(translation_m) * parent_q_child.normalized();
  links_.insert_or_assign(std::string(child), Link{std::string(parent), parent_T_child});
  return true;
}

std::optional<Eigen::Isometry3d> TfTree::robot_T(std::string_view frame) const {
  frame = without_slash(frame);
  if (!links_.contains(frame) && !is_parent(frame)) return std::nullopt;
  for (const std::string_view base : {"base_link", "base_footprint", ""}) {
    if (auto base_T_frame = chain(base, frame)) return base_T_frame;
  }
  return std::nullopt;
}

std::optional<double> TfTree::height_m(std::string_view frame) const {
  constexpr std::string_view kFloor = "base_footprint";
  frame = without_slash(frame);
  const auto root_T_floor = chain("", kFloor), root_T_frame = chain("", frame);
  if (!root_T_floor || !root_T_frame || root_of(kFloor) != root_of(frame)) return std::nullopt;
  return (root_T_floor->inverse() * *root_T_frame).translation().z();
}

/// REQUIRES: no circle above the frame.
std::string_view TfTree::root_of(std::string_view frame) const {
  auto link = links_.find(frame);
  while (link != links_.end()) {
    frame = link->second.parent;
    link = links_.find(frame);
  }
  return frame;
}

/// Climbs from the frame to `base`, or to the root if that is empty.
std::optional<Eigen::Isometry3d> TfTree::chain(std::string_view base, std::string_view frame) const {
  Eigen::Isometry3d at_T_frame = Eigen::Isometry3d::Identity();
  std::string_view at = frame;
  for (std::size_t steps = 0; steps <= links_.size(); ++steps) {
    if (at == base) return at_T_frame;
    const auto link = links_.find(at);
    if (link == links_.end()) return base.empty() ? std::optional(at_T_frame) : std::nullopt;
    at_T_frame = link->second.parent_T_child * at_T_frame;
    at = link->second.parent;
  }
  return std::nullopt;  // a circle
}

bool TfTree::is_parent(std::string_view frame) const {
  return std::any_of(links_.begin(), links_.end(),
                     [&](const auto& link) { return link.second.parent == frame; });
}

}  // namespace dynslam
