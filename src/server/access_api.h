// SPDX-License-Identifier: MIT
#pragma once

#include "server/access/access.h"
#include "server/gate.h"
#include "server/route_table.h"

namespace dynslam {

/// The requests of web/openapi.yaml about who may use the robot. Any thread.
class AccessApi {
 public:
  /// Both must outlive this.
  AccessApi(Access& access, Gate& gate) : access_(access), gate_(gate) {}

  void add_to(RouteTable& routes);

 private:
  using Handler = HttpAnswer (AccessApi::*)(const HttpRequest&, const Visitor&, const std::string& name);
  void add(RouteTable& routes, const char* method, const char* path, Role needed, Handler handler);

  HttpAnswer pair(const HttpRequest&, const Visitor&, const std::string&);
  HttpAnswer me(const HttpRequest&, const Visitor&, const std::string&);
  HttpAnswer logout(const HttpRequest&, const Visitor&, const std::string&);
  HttpAnswer people(const HttpRequest&, const Visitor&, const std::string&);
  HttpAnswer invite(const HttpRequest&, const Visitor&, const std::string&);
  HttpAnswer make_token(const HttpRequest&, const Visitor&, const std::string&);
  HttpAnswer revoke(const HttpRequest&, const Visitor&, const std::string& id);

  Access& access_;
  Gate& gate_;
};

}  // namespace dynslam
