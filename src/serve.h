// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "config.h"
#include "robot/ports.h"
#include "server/server.h"

namespace dynslam {

struct ServeOptions {
  std::optional<int> port;  ///< in place of the config's
  std::string world;        ///< that is simulated; empty on a real robot
};

/// The server of a program that runs a robot, wired to its settings. Prints the address to open.
class Serving {
 public:
  /// All references must outlive this. Throws std::runtime_error, in one line, when it cannot listen.
  Serving(Ports& ports, const Clock& clock, const Config& config, const ServeOptions& options);

  /// Whether a person holds the wheel.
  bool is_driven() const { return server_->is_driven(); }

 private:
  std::unique_ptr<Gate> gate_;
  std::unique_ptr<Server> server_;
};

}  // namespace dynslam
