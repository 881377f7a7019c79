// SPDX-License-Identifier: MIT
#pragma once

#include <mutex>
#include <string>

#include "robot/ports.h"
#include "server/api.h"
#include "server/gate.h"
#include "server/route_table.h"

namespace dynslam {

/// The requests of web/openapi.yaml about what can be set while the robot runs. Any thread.
class SettingsApi {
 public:
  SettingsApi(Ports& ports, Gate& gate, const ServerFacts& facts);

  void add_to(RouteTable& routes);

 private:
  HttpAnswer settings() const;
  HttpAnswer change(const HttpRequest& request);

  Ports& ports_;
  Gate& gate_;
  double least_m_, most_m_;  ///< of the trusted range; it must be more than the least
  mutable std::mutex mutex_;
  std::string name_;
};

}  // namespace dynslam
