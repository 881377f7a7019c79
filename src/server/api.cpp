// SPDX-License-Identifier: MIT
#include "server/api.h"

#include <algorithm>
#include <map>

#include <nlohmann/json.hpp>

#include "grid/trinary_map.h"
#include "io/map_file.h"
#include "io/map_picture.h"
#include "server/body_fields.h"
#include "server/embedded_files.h"
#include "server/metrics_text.h"
#include "server/state_json.h"

namespace dynslam {
namespace {

using nlohmann::json;

constexpr const char* kNoAutopilot = "this robot has no autopilot; drive it by hand";

HttpAnswer with_type(std::string type, std::string body) {
  HttpAnswer answer;
  answer.type = std::move(type);
  answer.body = std::move(body);
  return answer;
}

HttpAnswer with_json(const json& message) { return with_type("application/json", text_of(message)); }

HttpAnswer done() {
  HttpAnswer answer;
  answer.status = 204;
  return answer;
}

GridSnapshot map_of(const Ports& ports) {
  const auto world = ports.world.get().value;
  return world ? world->map : GridSnapshot();
}

bool is_on_map(const GridSnapshot& map, const Vector2& point) {
  constexpr double kFarthest_m = 1e6;
  if (!(point.cwiseAbs().maxCoeff() < kFarthest_m)) return false;
  return map.find(chunk_of(cell_at(point, map.cell_size_m()))) != nullptr;
}

}  // namespace

Api::Api(Ports& ports, const Clock& clock, Gate& gate, Wheel& wheel, NoteBook& notes, EventCounters& events,
         ServerFacts facts)
    : ports_(ports),
      clock_(clock),
      gate_(gate),
      wheel_(wheel),
      notes_(notes),
      events_(events),
      facts_(std::move(facts)) {}

void Api::add_to(RouteTable& routes) {
  add(routes, "GET", "/healthz", Role::kNone, &Api::health);
  add(routes, "GET", "/metrics", Role::kViewer, &Api::metrics);
  add(routes, "GET", "/api/v1/openapi.yaml", Role::kViewer, &Api::contract);
  add(routes, "GET", "/api/v1/state", Role::kViewer, &Api::state);
  add(routes, "GET", "/api/v1/devices", Role::kViewer, &Api::devices);
  add(routes, "GET", "/api/v1/config", Role::kViewer, &Api::config);
  add(routes, "GET", "/api/v1/worlds", Role::kViewer, &Api::worlds);
  add(routes, "GET", "/api/v1/graph", Role::kViewer, &Api::graph);
  add(routes, "GET", "/api/v1/log", Role::kViewer, &Api::log);
  add(routes, "GET", "/api/v1/map.png", Role::kViewer, &Api::map_png);
  add(routes, "GET", "/api/v1/map.pgm", Role::kViewer, &Api::map_pgm);
  add(routes, "GET", "/api/v1/map.yaml", Role::kViewer, &Api::map_yaml);
  add(routes, "POST", "/api/v1/goal", Role::kDriver, &Api::goal);
  add(routes, "POST", "/api/v1/mode", Role::kDriver, &Api::mode);
  add(routes, "POST", "/api/v1/power_limit", Role::kDriver, &Api::power_limit);
  routes.add("POST", "/api/v1/stop", [this](const HttpRequest& request, const std::string&) {
    const Gate::Decision decision = gate_.admit_to_stop(request);
    return decision.refusal ? *decision.refusal : stop(request, decision.visitor);
  });
  add(routes, "POST", "/api/v1/clear_stop", Role::kDriver, &Api::clear_stop);
}

void Api::add(RouteTable& routes, const char* method, const char* path, Role needed, Handler handler) {
  routes.add(method, path, [this, needed, handler](const HttpRequest& request, const std::string&) {
    const Gate::Decision decision = gate_.admit(request, needed);
    return decision.refusal ? *decision.refusal : (this->*handler)(request, decision.visitor);
  });
}

HttpAnswer Api::health(const HttpRequest&, const Visitor&) {
  const std::chrono::duration<double> up = std::chrono::steady_clock::now() - begun_;
  return with_json({{"status", "ok"}, {"version", facts_.version}, {"uptime_s", up.count()}});
}

HttpAnswer Api::metrics(const HttpRequest&, const Visitor&) {
  const Wheel::Delays delays = wheel_.delays();
  Counters counters = events_.get();
  for (const auto& [name, n] : access_counts()) counters.add(name, n);
  return with_type(
      "text/plain; version=0.0.4",
      metrics_text(ports_, {counters, connections(), delays.command_to_motor, delays.drop_to_off}));
}

HttpAnswer Api::contract(const HttpRequest&, const Visitor&) {
  return with_type("application/yaml", std::string(embedded_file("openapi.yaml")));
}

std::string Api::state_text() const {
  StateExtras extras{clock_.now(),  ports_.scan.get().version, wheel_.holder(0).driver,
                     events_.get(), notes_.map_id(),           ports_.map_notes.get().version};
  wheel_.answered();
  return text_of(state_json(ports_, extras));
}

HttpAnswer Api::state(const HttpRequest&, const Visitor&) {
  return with_type("application/json", state_text());
}

HttpAnswer Api::devices(const HttpRequest&, const Visitor&) { return with_json(devices_json(ports_)); }

HttpAnswer Api::config(const HttpRequest&, const Visitor&) {
  return with_type("application/json", facts_.config_json);
}

HttpAnswer Api::worlds(const HttpRequest&, const Visitor&) {
  json answer = {{"worlds", facts_.worlds}, {"current", nullptr}};
  if (!facts_.world.empty()) answer["current"] = facts_.world;
  return with_json(answer);
}

HttpAnswer Api::graph(const HttpRequest&, const Visitor&) { return with_json(graph_json(ports_)); }

HttpAnswer Api::log(const HttpRequest&, const Visitor&) { return with_json(log_json(ports_)); }

/// That of a large building has some ten megabytes, which a slow client keeps from the robot until it has
/// them.
HttpAnswer Api::map_answer(HttpAnswer (*make)(const GridSnapshot&)) {
  constexpr int kMost = 2;
  const std::shared_ptr<void> place(this, [this](void*) { --maps_on_the_way_; });
  if (++maps_on_the_way_ > kMost)
    return error_answer(503, "the map is being sent to others; try again in a moment");
  HttpAnswer answer = make(map_of(ports_));
  answer.held = place;
  return answer;
}

HttpAnswer Api::map_png(const HttpRequest&, const Visitor&) {
  return map_answer([](const GridSnapshot& map) { return with_type("image/png", to_png(trinary_map(map))); });
}

HttpAnswer Api::map_pgm(const HttpRequest&, const Visitor&) {
  return map_answer([](const GridSnapshot& map) {
    return with_type("image/x-portable-graymap", to_pgm(trinary_map(map)));
  });
}

HttpAnswer Api::map_yaml(const HttpRequest&, const Visitor&) {
  return map_answer([](const GridSnapshot& map) {
    return with_type("application/yaml", to_map_yaml(trinary_map(map), "map.pgm"));
  });
}

HttpAnswer Api::goal(const HttpRequest& request, const Visitor& visitor) {
  BodyFields body(request);
  Destination to = body.destination();
  to.name = body.text_if("name").value_or("");
  if (const auto problem = body.problem()) return *problem;
  if (!to.name.empty())
    if (const auto problem = note_name_problem(to.name)) return error_answer(422, *problem);
  if (!is_on_map(map_of(ports_), to.point_map)) return error_answer(422, "the goal is not on the map");
  return order(GoThere{std::move(to)}, visitor);
}

HttpAnswer Api::mode(const HttpRequest& request, const Visitor& visitor) {
  static const std::map<std::string, Order, std::less<>> kOrders = {
      {"manual", SwitchOff{}}, {"navigate", StandBy{}}, {"explore", Explore{}}, {"home", GoHome{}}};
  BodyFields body(request);
  const std::string mode = body.text("mode");
  const std::vector<std::string> places = body.texts_if("places");
  if (const auto problem = body.problem()) return *problem;
  if (mode == "patrol") {
    auto route = patrol(places);
    const auto* refusal = std::get_if<HttpAnswer>(&route);
    return refusal != nullptr ? *refusal : order(std::get<Order>(std::move(route)), visitor);
  }
  const auto found = kOrders.find(mode);
  if (found == kOrders.end())
    return error_answer(422, "mode must be manual, navigate, explore, home or patrol");
  if (!places.empty()) return error_answer(422, "places are for patrol");
  return order(found->second, visitor);
}

std::variant<Order, HttpAnswer> Api::patrol(const std::vector<std::string>& names) const {
  if (names.empty() || names.size() > kMostPlaces) return error_answer(422, "a patrol has 1 to 64 places");
  const Notes notes = notes_.notes();
  Patrol patrol;
  for (const std::string& name : names) {
    const auto place = std::find_if(notes.places.begin(), notes.places.end(),
                                    [&](const Destination& p) { return p.name == name; });
    if (place == notes.places.end()) return error_answer(422, "there is no place named " + name);
    patrol.stops.push_back(*place);
  }
  return patrol;
}

/// What comes of it is in the state.
HttpAnswer Api::order(Order order, const Visitor& visitor) {
  if (!ports_.autopilot.get().value)
    return std::holds_alternative<SwitchOff>(order) ? done() : error_answer(501, kNoAutopilot);
  const auto driver = wheel_.order(std::move(order), visitor.id, std::chrono::steady_clock::now());
  if (driver) return error_answer(409, *driver + " is driving; ask, or take the wheel over");
  events_.add("server.orders");
  return done();
}

HttpAnswer Api::power_limit(const HttpRequest& request, const Visitor&) {
  BodyFields body(request);
  const double limit = body.number("power_limit");
  if (const auto problem = body.problem()) return *problem;
  if (limit < 0.0 || limit > 1.0) return error_answer(422, "power_limit must be from 0 to 1");
  ports_.power_limit = limit;
  return done();
}

HttpAnswer Api::stop(const HttpRequest& request, const Visitor& visitor) {
  ports_.stops.push(visitor.name.empty() ? "somebody at " + request.address : visitor.name);
  events_.add("server.stops");
  return done();
}

HttpAnswer Api::clear_stop(const HttpRequest&, const Visitor&) {
  ports_.clear_asked = true;
  return done();
}

}  // namespace dynslam
