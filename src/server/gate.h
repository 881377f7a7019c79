// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "server/access/role.h"
#include "server/http_message.h"
#include "server/watch_channels.h"

namespace dynslam {

/// Who is let in, and as what.
struct Visitor {
  std::string name;  ///< empty for a stranger
  Role role = Role::kNone;
  std::string id;              ///< of what let him in
  StillAllowed still_allowed;  ///< for what lasts longer than a request
};

/// Decides who may do what, by what a request says of itself. Any thread.
class Gate {
 public:
  struct Decision {
    std::optional<HttpAnswer> refusal;
    Visitor visitor;  ///< when there is no refusal
  };
  virtual ~Gate() = default;
  virtual Decision admit(const HttpRequest& request, Role needed) = 0;
  /// To stopping the robot, which takes less than anything else.
  virtual Decision admit_to_stop(const HttpRequest& request) = 0;
};

}  // namespace dynslam
