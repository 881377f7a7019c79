// SPDX-License-Identifier: MIT
#pragma once

#include "server/gate.h"
#include "server/route_table.h"

namespace dynslam {

/// The page and what it is made of, at `/`: for everybody on the local network, as strangers come in by it,
/// and as there is nothing in it that they may not see. `gate` must outlive the routes.
void add_page(RouteTable& routes, Gate& gate);

}  // namespace dynslam
