// SPDX-License-Identifier: MIT
#include "robot/mapping_result.h"

namespace dynslam {
namespace {

PicturedEdge::Kind kind_of(EdgeKind kind) {
  switch (kind) {
    case EdgeKind::kLoop:
      return PicturedEdge::Kind::kLoop;
    case EdgeKind::kTurn:
      return PicturedEdge::Kind::kTurn;
    default:
      return PicturedEdge::Kind::kOdometry;
  }
}

GraphPicture picture_of(const BackEnd& back_end) {
  GraphPicture picture;
  for (const GraphNode& node : back_end.graph().nodes())
    picture.maps.push_back({node.id, node.map_T_node, true});
  for (const std::uint32_t id : back_end.retired())
    picture.maps.push_back({id, back_end.map_T_origin(id), false});
  for (const GraphEdge& e : back_end.graph().edges())
    picture.edges.push_back({kind_of(e.kind), e.a, e.b, e.residual});
  for (const RefusedLoop& r : back_end.loops().refused())
    picture.refused.push_back({r.a, r.b, r.a_T_b, r.reason});
  for (const RefusedLoop& r : back_end.loops().let_go())
    picture.let_go.push_back({r.a, r.b, r.a_T_b, r.reason});
  return picture;
}

}  // namespace

std::vector<StampedPose> poses_of(const Slam& slam) {
  std::vector<StampedPose> poses;
  for (const StampedFix& fix : slam.trajectory()) poses.push_back({fix.stamp, fix.map_T_robot});
  return poses;
}

void take_result(Slam& slam, MappingResult& result) {
  result.trajectory = poses_of(slam);
  result.graph = picture_of(slam.back_end());
  result.loop_closures = slam.back_end().loops().closures();
  result.map = slam.global_map().snapshot();
  result.map_bytes = slam.global_map().bytes();
  result.local_maps = slam.local_maps_begun();
  result.local_maps_active = slam.local_maps_active();
  result.findings = slam.findings();
}

}  // namespace dynslam
