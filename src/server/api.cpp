// SPDX-License-Identifier: MIT
#include "server/api.h"

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

constexpr const char* kNoAutopilot = "this robot has no autopilot yet; drive it by hand";

std::string text_of(const json& message) {
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

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

HttpAnswer done_unless(const std::string& refusal) {
  return refusal.empty() ? done() : error_answer(409, refusal);
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

Api::Api(Ports& ports, const Clock& clock, Gate& gate, Wheel& wheel, EventCounters& events, ServerFacts facts,
         AutopilotPort autopilot)
    : ports_(ports),
      clock_(clock),
      gate_(gate),
      wheel_(wheel),
      events_(events),
      facts_(std::move(facts)),
      autopilot_(std::move(autopilot)) {}

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
  StateExtras extras{clock_.now(), ports_.scan.get().version, wheel_.holder(0).driver, events_.get()};
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

HttpAnswer Api::goal(const HttpRequest& request, const Visitor&) {
  BodyFields body(request);
  const Vector2 point(body.number("x_m"), body.number("y_m"));
  const std::optional<double> yaw = body.number_if("yaw_rad");
  if (const auto problem = body.problem()) return *problem;
  if (!is_on_map(map_of(ports_), point)) return error_answer(422, "the goal is not on the map");
  if (!autopilot_.go_to) return error_answer(501, kNoAutopilot);
  return done_unless(
      autopilot_.go_to({point.x(), point.y(), wrap_angle(yaw.value_or(0.0))}, yaw.has_value()));
}

HttpAnswer Api::mode(const HttpRequest& request, const Visitor&) {
  BodyFields body(request);
  const std::string mode = body.text("mode");
  if (const auto problem = body.problem()) return *problem;
  if (mode != "manual" && mode != "explore") return error_answer(422, "mode must be manual or explore");
  if (autopilot_.set_mode) return done_unless(autopilot_.set_mode(mode));
  return mode == "manual" ? done() : error_answer(501, kNoAutopilot);
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
