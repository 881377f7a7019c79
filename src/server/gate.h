// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "server/http_message.h"
#include "server/watch_channels.h"

namespace dynslam {

/// What a request needs. Each may what the one before may.
enum class Right { kAnyone, kViewer, kDriver, kAdmin };

/// Who is let in, and as what.
struct Visitor {
  std::string name;
  Right right = Right::kAnyone;
  StillAllowed still_allowed;  ///< for what lasts longer than a request
};

/// Decides who may do what. Any thread.
class Gate {
 public:
  struct Decision {
    std::optional<HttpAnswer> refusal;
    Visitor visitor;  ///< when there is no refusal
  };
  virtual ~Gate() = default;
  virtual Decision admit(const HttpRequest& request, Right needed) = 0;
};

}  // namespace dynslam
