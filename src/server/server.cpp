// SPDX-License-Identifier: MIT
#include "server/server.h"

#include <algorithm>
#include <random>

#include "server/control_channel.h"
#include "server/page_routes.h"

namespace dynslam {
namespace {

constexpr std::string_view kSockets = "/api/v1/ws/";
constexpr std::string_view kStop = "/api/v1/stop";

/// Tells the maps of two runs apart on the wire; never 0.
std::uint64_t new_map_number() {
  std::random_device random;
  return (std::uint64_t{random()} << 32 | random()) | 1U;
}

Seats::Use use_of(const HttpRequest& request) {
  if (request.path == kStop) return Seats::Use::kStop;
  if (!request.path.starts_with(kSockets)) return Seats::Use::kRequest;
  return request.path.substr(kSockets.size()) == "control" ? Seats::Use::kControl : Seats::Use::kWatch;
}

Seats::Limits limits_of(const ServerConfig& config) {
  return {static_cast<std::size_t>(config.seats), static_cast<std::size_t>(config.seats_kept),
          static_cast<std::size_t>(config.seats_per_address)};
}

}  // namespace

Server::Server(Ports& ports, const Clock& clock, Access& access, NoteBook& notes, const ServerConfig& config,
               const ServerFacts& facts, std::function<bool()> drives_itself)
    : ports_(ports),
      clock_(clock),
      gate_(access),
      wheel_(ports, clock, facts.limits, std::move(drives_itself)),
      api_(ports, clock, gate_, wheel_, notes, events_, facts),
      access_api_(access, gate_),
      recordings_api_(ports, gate_, facts.recordings),
      settings_api_(ports, gate_, facts),
      notes_api_(notes, gate_),
      state_feed_(ports, [this] { return api_.state_text(); }),
      map_feed_(ports, clock, new_map_number()),
      web_({config.bind, config.port, limits_of(config)}, handlers(access)) {
  serving_ = &web_;
}

WebServer::Handlers Server::handlers(Access& access) {
  api_.connections = [this] {
    const WebServer* web = serving_;
    return web == nullptr ? std::size_t{0} : web->connections();
  };
  api_.access_counts = [&access] { return access.counts(); };
  api_.add_to(routes_);
  access_api_.add_to(routes_);
  recordings_api_.add_to(routes_);
  settings_api_.add_to(routes_);
  notes_api_.add_to(routes_);
  add_page(routes_, gate_);
  return {[this](const HttpRequest& request) { return answer(request); },
          [this](const HttpRequest& request) { return open(request); }, use_of};
}

/// Who may not ask at all does not learn what there is not either.
HttpAnswer Server::answer(const HttpRequest& request) {
  HttpAnswer answer = routes_.answer(request);
  if (answer.status != 404 && answer.status != 405) return answer;
  const Gate::Decision decision = gate_.admit_to_stop(request);
  return decision.refusal ? *decision.refusal : answer;
}

std::variant<std::unique_ptr<Channel>, HttpAnswer> Server::open(const HttpRequest& request) {
  const std::string kind = request.path.substr(std::min(kSockets.size(), request.path.size()));
  Gate::Decision decision = gate_.admit(request, Role::kViewer);
  if (decision.refusal) return *decision.refusal;
  if (kind != "control" && kind != "state" && kind != "map" && kind != "video")
    return error_answer(404, "there is no such WebSocket");
  Visitor& visitor = decision.visitor;
  if (kind == "state") return std::make_unique<StateChannel>(state_feed_, std::move(visitor.still_allowed));
  if (kind == "map") return std::make_unique<MapChannel>(map_feed_, std::move(visitor.still_allowed));
  if (kind == "video") return std::make_unique<VideoChannel>(ports_, std::move(visitor.still_allowed));
  return std::make_unique<ControlChannel>(
      wheel_, ports_, clock_, events_, ControlClient{visitor.name, visitor.role >= Role::kDriver, visitor.id},
      std::move(visitor.still_allowed));
}

}  // namespace dynslam
