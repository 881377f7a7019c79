// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "base/config_field.h"

namespace dynslam {

/// Section [server] of the configuration.
struct ServerConfig {
  int port = 8080;
  std::string bind;
  int seats = 64;
  int seats_kept = 8;
  int seats_per_address = 40;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"port", "where the page is served; 0: any port that is free", 0, 65535}, self.port);
    visit(Field{"bind", "the address of this machine to serve on; empty: all of them"}, self.bind);
    visit(Field{"seats", "connections that are served at the same time, each by a thread", 16, 512},
          self.seats);
    visit(Field{"seats_kept", "of these, kept for driving and STOP", 4, 12}, self.seats_kept);
    visit(Field{"seats_per_address", "connections that one address may have", 4, 512},
          self.seats_per_address);
  }
};

}  // namespace dynslam
