// SPDX-License-Identifier: MIT
#include "serve.h"

#include <cstdio>

#include <nlohmann/json.hpp>

#include "sim/builtin_worlds.h"

namespace dynslam {
namespace {

class LoopbackGate : public Gate {
 public:
  Decision admit(const HttpRequest& request, Right) override {
    if (!request.address.starts_with("127.") && request.address != "::1")
      return {error_answer(403, "only from this machine"), {}};
    return {std::nullopt, {"this machine", Right::kAdmin, [] { return std::string(); }}};
  }
};

ServerFacts facts_of(const Config& config, const ServeOptions& options) {
  ServerFacts facts{DYNSLAM_VERSION, config_json(config).dump(), {}, options.world, {}};
  facts.limits = {config.drive.kinematics.max_speed_mps, config.drive.kinematics.max_turn_radps};
  if (!options.world.empty())
    for (const BuiltinWorld& world : builtin_worlds()) facts.worlds.emplace_back(world.name);
  return facts;
}

}  // namespace

Serving::Serving(Ports& ports, const Clock& clock, const Config& config, const ServeOptions& options)
    : gate_(std::make_unique<LoopbackGate>()) {
  ServerConfig server = config.server;
  if (options.port) server.port = *options.port;
  server_ = std::make_unique<Server>(ports, clock, *gate_, server, facts_of(config, options));
  const std::string host = server.bind.empty() ? "localhost" : server.bind;
  std::printf("http://%s:%d/\n", host.c_str(), server_->port());
  std::fflush(stdout);
}

}  // namespace dynslam
