// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <variant>

#include "server/channel.h"
#include "server/http_message.h"
#include "server/seats.h"

namespace dynslam {

/// HTTP and WebSockets on a port: the one place that knows civetweb. Its threads, one for each connection,
/// call the handlers; each seat of `Seats` is one of them. Plain HTTP only.
class WebServer {
 public:
  struct Options {
    std::string bind;  ///< an address of this machine; empty: all of them
    int port = 8080;   ///< 0: any that is free
    Seats::Limits seats;
  };
  struct Handlers {
    /// Answers a request. Any thread. What it throws becomes a 500.
    std::function<HttpAnswer(const HttpRequest&)> answer;
    /// Opens a WebSocket, or says why not.
    std::function<std::variant<std::unique_ptr<Channel>, HttpAnswer>(const HttpRequest&)> open;
    /// What seat a request needs.
    std::function<Seats::Use(const HttpRequest&)> use;
  };

  static constexpr std::size_t kLongestBody = 16 * 1024;

  /// Listens from now on. Throws std::runtime_error with one line when it cannot.
  WebServer(const Options& options, Handlers handlers);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  int port() const;
  /// Whether it can be asked by IPv6: Debian 12's civetweb cannot.
  static bool answers_ipv6();
  std::size_t connections() const;
  std::uint64_t refused() const;  ///< connections and requests for which there was no seat

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace dynslam
