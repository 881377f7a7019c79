// SPDX-License-Identifier: MIT
#pragma once

#include "server/access/access.h"
#include "server/gate.h"

namespace dynslam {

/// The gate that Access keeps.
class AccessGate : public Gate {
 public:
  /// `access` must outlive it and what it let in.
  explicit AccessGate(Access& access) : access_(access) {}

  Decision admit(const HttpRequest& request, Role needed) override;
  Decision admit_to_stop(const HttpRequest& request) override;

 private:
  Access& access_;
};

}  // namespace dynslam
