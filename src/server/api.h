// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "pipe/clock.h"
#include "robot/ports.h"
#include "server/event_counters.h"
#include "server/gate.h"
#include "server/note_book.h"
#include "server/route_table.h"
#include "server/wheel.h"

namespace dynslam {

/// What the program tells the server about itself.
struct ServerFacts {
  std::string version;
  std::string config_json = "{}";   ///< without secrets
  std::vector<std::string> worlds;  ///< of the simulator
  std::string world;                ///< the one that is simulated; empty on a real robot
  std::string recordings;           ///< folder
  TwistLimits limits;
  std::string name = {};                                             ///< of the robot
  double trusted_range_least_m = 0.0, trusted_range_most_m = 100.0;  ///< for SLAM; the least is too little
};

/// The requests of web/openapi.yaml about the robot. Any thread.
class Api {
 public:
  Api(Ports& ports, const Clock& clock, Gate& gate, Wheel& wheel, NoteBook& notes, EventCounters& events,
      ServerFacts facts);

  void add_to(RouteTable& routes);
  std::string state_text() const;
  /// Connections that are open; known once the server runs.
  std::function<std::size_t()> connections = [] { return std::size_t{0}; };
  /// What was refused.
  std::function<Counters()> access_counts = [] { return Counters(); };

 private:
  using Handler = HttpAnswer (Api::*)(const HttpRequest&, const Visitor&);
  void add(RouteTable& routes, const char* method, const char* path, Role needed, Handler handler);

  HttpAnswer health(const HttpRequest&, const Visitor&);
  HttpAnswer metrics(const HttpRequest&, const Visitor&);
  HttpAnswer contract(const HttpRequest&, const Visitor&);
  HttpAnswer state(const HttpRequest&, const Visitor&);
  HttpAnswer devices(const HttpRequest&, const Visitor&);
  HttpAnswer config(const HttpRequest&, const Visitor&);
  HttpAnswer worlds(const HttpRequest&, const Visitor&);
  HttpAnswer graph(const HttpRequest&, const Visitor&);
  HttpAnswer log(const HttpRequest&, const Visitor&);
  HttpAnswer map_answer(HttpAnswer (*make)(const GridSnapshot&));
  HttpAnswer map_png(const HttpRequest&, const Visitor&);
  HttpAnswer map_pgm(const HttpRequest&, const Visitor&);
  HttpAnswer map_yaml(const HttpRequest&, const Visitor&);
  HttpAnswer goal(const HttpRequest&, const Visitor&);
  HttpAnswer mode(const HttpRequest&, const Visitor&);
  HttpAnswer order(Order order, const Visitor& visitor);
  std::variant<Order, HttpAnswer> patrol(const std::vector<std::string>& names) const;
  HttpAnswer power_limit(const HttpRequest&, const Visitor&);
  HttpAnswer stop(const HttpRequest&, const Visitor&);
  HttpAnswer clear_stop(const HttpRequest&, const Visitor&);

  Ports& ports_;
  const Clock& clock_;
  Gate& gate_;
  Wheel& wheel_;
  NoteBook& notes_;
  EventCounters& events_;
  ServerFacts facts_;
  std::atomic<int> maps_on_the_way_{0};
  Clock::SteadyTime begun_ = std::chrono::steady_clock::now();
};

}  // namespace dynslam
