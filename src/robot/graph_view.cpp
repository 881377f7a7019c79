// SPDX-License-Identifier: MIT
#include "robot/graph_view.h"

#include "slam/back_end.h"

namespace dynslam {

GraphView graph_view(const BackEnd& back_end) {
  GraphView view{back_end.graph().nodes(), {}};
  for (const GraphEdge& edge : back_end.graph().edges())
    if (edge.kind == EdgeKind::kLoop) view.closures.push_back({edge.a, edge.b});
  return view;
}

}  // namespace dynslam
