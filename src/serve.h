// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "config.h"
#include "robot/ports.h"
#include "robot/stop_signal.h"
#include "server/server.h"

namespace dynslam {

struct ServeOptions {
  std::optional<int> port;                       ///< in place of the config's
  std::string world;                             ///< that is simulated; empty on a real robot
  std::function<bool()> drives_itself = {};      ///< see Server
  std::optional<std::string> state_folder = {};  ///< none: all is forgotten at the end
};

/// The server of a program that runs a robot, wired to its settings. Prints the address to open.
class Serving {
 public:
  /// All references must outlive this. Throws std::runtime_error, in one line, when it cannot listen.
  Serving(Ports& ports, const Clock& clock, const Config& config, const ServeOptions& options);
  ~Serving();
  Serving(const Serving&) = delete;
  Serving& operator=(const Serving&) = delete;

  /// Whether a person steers: see Server.
  bool is_steered() const { return server_->is_steered(); }

 private:
  void tend();
  void tell_where();
  void tell_trouble();

  Access access_;
  NoteBook notes_;
  std::optional<Server> server_;
  std::string owner_code_;          ///< as told last, as are the two that follow
  std::vector<std::string> where_;  ///< the page's first address, if it has one
  std::string trouble_;
  StopSignal ends_;
  std::thread tends_;
};

}  // namespace dynslam
