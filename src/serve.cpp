// SPDX-License-Identifier: MIT
#include "serve.h"

#include <algorithm>
#include <cstdio>
#include <string_view>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "base/wall_time.h"
#include "server/access/own_addresses.h"
#include "server/access/pairing_notice.h"
#include "sim/builtin_worlds.h"

namespace dynslam {
namespace {

constexpr std::chrono::seconds kLookEvery{5};
constexpr std::chrono::minutes kTendEvery{1};

std::string name_of(const ServerConfig& config) {
  return config.name.empty() ? own_host_name().substr(0, kLongestRobotName) : config.name;
}

ServerFacts facts_of(const Config& config, const ServeOptions& options) {
  ServerFacts facts;
  facts.version = DYNSLAM_VERSION;
  facts.config_json = config_json(config).dump();
  facts.world = options.world;
  facts.recordings = config.recorder.folder;
  facts.name = name_of(config.server);
  facts.trusted_range_least_m = config.slam.min_range_m;
  facts.trusted_range_most_m = config.slam.most_trusted_range_m();
  facts.limits = {config.drive.kinematics.max_speed_mps, config.drive.kinematics.max_turn_radps};
  if (!options.world.empty())
    for (const BuiltinWorld& world : builtin_worlds()) facts.worlds.emplace_back(world.name);
  return facts;
}

/// A simulation pairs by itself with who sits at this machine, and forgets all others at its end.
AccessSetup access_setup(const Config& config, const ServeOptions& options) {
  AccessSetup setup;
  setup.config = config.access;
  setup.host_name = own_host_name();
  setup.trust_loopback = config.access.simulation_pairs_itself && !options.world.empty();
  setup.addresses = own_addresses();
  setup.folder = options.state_folder;
  return setup;
}

/// Beside what Access has for itself.
std::optional<std::string> notes_folder(const ServeOptions& options) {
  return options.state_folder ? std::optional(*options.state_folder + "/notes") : std::nullopt;
}

void print(const std::string& text) {
  std::fputs(text.c_str(), stdout);
  std::fflush(stdout);
}

}  // namespace

Serving::Serving(Ports& ports, const Clock& clock, const Config& config, const ServeOptions& options)
    : access_(access_setup(config, options)),
      notes_(ports.map_notes, utc_text(wall_now()), notes_folder(options)) {
  if (!access_.notice().empty()) notes_.add_notice(access_.notice());
  notes_.tend(access_.trouble());
  if (const std::string notice = notes_.notes().notice; !notice.empty()) spdlog::warn("{}", notice);
  trouble_ = notes_.trouble();
  ServerConfig server = config.server;
  if (options.port) server.port = *options.port;
  server_.emplace(ports, clock, access_, notes_, server, facts_of(config, options), options.drives_itself);
  const std::string host = server.bind.empty() ? "localhost" : server.bind;
  print("http://" + host + ':' + std::to_string(server_->port()) + "/\n");
  access_.tend(AccessTime::now());
  tell_where();
  tends_ = std::thread([this] { tend(); });
}

Serving::~Serving() {
  ends_.request();
  tends_.join();
}

/// The code whenever it is another than before: it gets old, and there is a new one when nobody is an admin
/// any more. The address whenever it is another: a network may come long after the program.
void Serving::tell_where() {
  std::vector<std::string> addresses = own_addresses();
  access_.set_addresses(addresses);
  if (!Server::answers_ipv6())
    std::erase_if(addresses, [](const std::string& a) { return a.find(':') != std::string::npos; });
  const auto code = access_.owner_code(AccessTime::now());
  const std::string code_text = code ? code->text : "";
  std::vector<std::string> urls = page_urls(addresses, server_->port());
  urls.resize(std::min<std::size_t>(urls.size(), 1));
  const bool is_news = urls != where_ || (code && code_text != owner_code_);
  owner_code_ = code_text;
  where_ = std::move(urls);
  if (!is_news) return;
  print(code ? pairing_notice(*code, addresses, server_->port()) : page_notice(addresses, server_->port()));
}

/// In the log, when one begins and when it ends.
void Serving::tell_trouble() {
  const std::string trouble = notes_.trouble();
  if (trouble == trouble_) return;
  trouble_ = trouble;
  if (trouble.empty()) {
    spdlog::info("all is saved again");
  } else {
    spdlog::warn("nothing is saved until this is mended: {}", trouble);
  }
}

void Serving::tend() {
  auto due = std::chrono::steady_clock::now() + kTendEvery;
  while (!ends_.wait(std::chrono::steady_clock::now() + kLookEvery)) {
    tell_where();
    if (std::chrono::steady_clock::now() >= due) {
      access_.tend(AccessTime::now());
      notes_.tend(access_.trouble());
      due = std::chrono::steady_clock::now() + kTendEvery;
    }
    tell_trouble();
  }
}

}  // namespace dynslam
