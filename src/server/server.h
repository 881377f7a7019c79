// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <variant>

#include "server/access_api.h"
#include "server/access_gate.h"
#include "server/api.h"
#include "server/feeds.h"
#include "server/notes_api.h"
#include "server/recordings_api.h"
#include "server/server_config.h"
#include "server/settings_api.h"
#include "server/web_server.h"

namespace dynslam {

/// The way in: HTTP and WebSockets between people and a robot's ports (web/openapi.yaml, web/wire.md). Serves
/// from when it is made until it is destroyed, with threads of its own.
class Server {
 public:
  /// All references must outlive this. Throws std::runtime_error, in one line, when it cannot listen.
  /// `drives_itself`: whether the robot does though it has no active autopilot; empty: never.
  Server(Ports& ports, const Clock& clock, Access& access, NoteBook& notes, const ServerConfig& config,
         const ServerFacts& facts, std::function<bool()> drives_itself = {});

  int port() const { return web_.port(); }
  static bool answers_ipv6() { return WebServer::answers_ipv6(); }
  /// Whether a person steers, or did and has the wheel still: then nobody else commands.
  bool is_steered() const { return wheel_.is_steered(); }

 private:
  WebServer::Handlers handlers(Access& access);
  HttpAnswer answer(const HttpRequest& request);
  std::variant<std::unique_ptr<Channel>, HttpAnswer> open(const HttpRequest& request);

  Ports& ports_;
  const Clock& clock_;
  AccessGate gate_;
  EventCounters events_;
  Wheel wheel_;
  Api api_;
  AccessApi access_api_;
  RecordingsApi recordings_api_;
  SettingsApi settings_api_;
  NotesApi notes_api_;
  StateFeed state_feed_;
  MapFeed map_feed_;
  RouteTable routes_;
  std::atomic<WebServer*> serving_{nullptr};
  WebServer web_;  ///< the last: its threads use all the others
};

}  // namespace dynslam
