// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>

#include "server/gate.h"
#include "server/route_table.h"

namespace dynslam::test {

/// Lets everybody in as what is set.
struct FixedGate : Gate {
  explicit FixedGate(Role all_are) : right(all_are) {}
  Decision admit(const HttpRequest&, Role needed) override {
    if (right < needed) return {error_answer(403, "not for you"), {}};
    return {std::nullopt, {"Ada", right, {}, {}}};
  }
  Decision admit_to_stop(const HttpRequest& request) override { return admit(request, Role::kNone); }

  Role right;
};

/// Asks with a body of JSON, or without one.
inline HttpAnswer ask(const RouteTable& routes, const std::string& method, const std::string& path,
                      const std::string& body = {}, std::map<std::string, std::string> headers = {}) {
  if (!body.empty()) headers["content-type"] = "application/json";
  return routes.answer({method, path, {}, std::move(headers), body, "10.0.0.7"});
}

}  // namespace dynslam::test
