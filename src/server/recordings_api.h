// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "robot/ports.h"
#include "server/gate.h"
#include "server/route_table.h"

namespace dynslam {

/// The requests of web/openapi.yaml about recordings: what there are, begin and end one, fetch and delete.
/// Any thread.
class RecordingsApi {
 public:
  /// `folder`: where the robot keeps them. The references must outlive this.
  RecordingsApi(Ports& ports, Gate& gate, std::string folder)
      : ports_(ports), gate_(gate), folder_(std::move(folder)) {}

  void add_to(RouteTable& routes);

 private:
  using Handler = HttpAnswer (RecordingsApi::*)(const std::string& name);
  void add(RouteTable& routes, const char* method, const char* path, Role needed, Handler handler);

  HttpAnswer list(const std::string&);
  HttpAnswer start(const std::string&);
  HttpAnswer stop(const std::string&);
  HttpAnswer download(const std::string& name);
  HttpAnswer remove(const std::string& name);
  std::string path_of(const std::string& name) const;

  Ports& ports_;
  Gate& gate_;
  std::string folder_;
};

}  // namespace dynslam
