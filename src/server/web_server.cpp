// SPDX-License-Identifier: MIT
#include "server/web_server.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <mutex>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <vector>

#include <civetweb.h>
#include <dlfcn.h>
#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <pthread.h>
#include <sys/socket.h>
#include <unistd.h>

#include "server/connection_book.h"
#include "server/ws_session.h"

namespace dynslam {
namespace {

constexpr const char* kRequestTimeoutMs = "5000";
constexpr const char* kSockets = "/api/v1/ws";
constexpr std::size_t kLongBody = std::size_t{1} << 20;  ///< takes a slow client as long as it takes

const char* reason_of(int status) {
  switch (status) {
    case 200:
      return "OK";
    case 201:
      return "Created";
    case 204:
      return "No Content";
    case 400:
      return "Bad Request";
    case 401:
      return "Unauthorized";
    case 403:
      return "Forbidden";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    case 409:
      return "Conflict";
    case 413:
      return "Content Too Large";
    case 415:
      return "Unsupported Media Type";
    case 422:
      return "Unprocessable Content";
    case 429:
      return "Too Many Requests";
    case 501:
      return "Not Implemented";
    case 503:
      return "Service Unavailable";
    default:
      return status < 500 ? "Error" : "Internal Server Error";
  }
}

std::string head_of(const HttpAnswer& answer, std::size_t size) {
  std::string head = "HTTP/1.1 " + std::to_string(answer.status) + ' ' + reason_of(answer.status) + "\r\n";
  const auto add = [&head](const std::string& name, const std::string& value) {
    head += name + ": " + value + "\r\n";
  };
  if (answer.status != 204) add("Content-Type", answer.type);
  add("Content-Length", std::to_string(size));
  add("Connection", "close");
  add("Cache-Control", "no-store");
  add("X-Content-Type-Options", "nosniff");
  add("Referrer-Policy", "no-referrer");
  // Nor may a foreign page show the map as a picture where this machine is trusted.
  add("Cross-Origin-Resource-Policy", "same-origin");
  add("Content-Security-Policy",
      "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
      "connect-src 'self'; worker-src 'self'; manifest-src 'self'; base-uri 'none'; form-action 'self'; "
      "frame-ancestors 'none'");
  for (const auto& [name, value] : answer.headers) add(name, value);
  return head + "\r\n";
}

void write_answer(mg_connection* connection, const HttpAnswer& answer, bool head_only) {
  const std::string head = head_of(answer, answer.body.size());
  if (mg_write(connection, head.data(), head.size()) <= 0 || head_only) return;
  mg_write(connection, answer.body.data(), answer.body.size());
}

/// What the file holds now; it may be growing. Returns the status that was sent.
int write_file(mg_connection* connection, const HttpAnswer& answer, bool head_only) {
  std::ifstream file(answer.file, std::ios::binary | std::ios::ate);
  if (!file) {
    write_answer(connection, error_answer(404, "the file is not there any more"), head_only);
    return 404;
  }
  auto left = static_cast<std::size_t>(file.tellg());
  file.seekg(0);
  const std::string head = head_of(answer, left);
  if (mg_write(connection, head.data(), head.size()) <= 0 || head_only) return answer.status;
  std::vector<char> bytes(64 * 1024);
  while (left > 0) {
    file.read(bytes.data(), static_cast<std::streamsize>(std::min(left, bytes.size())));
    const auto n = static_cast<std::size_t>(file.gcount());
    if (n == 0 || mg_write(connection, bytes.data(), n) < static_cast<int>(n)) break;
    left -= n;
  }
  return answer.status;
}

void add_query(const char* text, HttpRequest& request) {
  const std::string_view query = text == nullptr ? "" : text;
  for (std::size_t at = 0; at < query.size();) {
    const std::size_t end = std::min(query.find('&', at), query.size());
    const std::string_view pair = query.substr(at, end - at);
    const std::size_t equals = std::min(pair.find('='), pair.size());
    request.query.emplace(pair.substr(0, equals), pair.substr(std::min(equals + 1, pair.size())));
    at = end + 1;
  }
}

HttpRequest head_of(const mg_connection* connection) {
  const mg_request_info* info = mg_get_request_info(connection);
  HttpRequest request;
  request.method = info->request_method;
  request.path = info->local_uri != nullptr ? info->local_uri : "";
  request.address = plain_address(info->remote_addr);
  add_query(info->query_string, request);
  for (int i = 0; i < info->num_headers; ++i) {
    std::string name = info->http_headers[i].name;
    for (char& c : name) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    request.headers.emplace(std::move(name), info->http_headers[i].value);
  }
  return request;
}

/// False when there is more than anybody may send.
bool read_body(mg_connection* connection, HttpRequest& request) {
  if (mg_get_request_info(connection)->content_length > static_cast<long long>(WebServer::kLongestBody))
    return false;
  std::array<char, 4096> bytes;
  for (int n = 0; (n = mg_read(connection, bytes.data(), bytes.size())) > 0;) {
    request.body.append(bytes.data(), static_cast<std::size_t>(n));
    if (request.body.size() > WebServer::kLongestBody) return false;
  }
  return true;
}

/// Connects to a port of this machine, once.
void knock(int port) {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket < 0) return;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  // Whether anybody answers does not matter: it is being asked that wakes.
  static_cast<void>(connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof(address)));
  close(socket);
}

/// civetweb's threads have small stacks, too little to draw a map on; this waits for one with more.
template <class Work>
bool with_room(Work&& work) {
  try {
    std::thread(std::forward<Work>(work)).join();
    return true;
  } catch (const std::system_error&) {
    return false;  // the system has no thread left
  }
}

bool is_upgrade(const HttpRequest& request) {
  return request.path.starts_with(kSockets) && !request.header("upgrade").empty();
}

Peer peer_of(const mg_connection* connection) {
  const mg_request_info* info = mg_get_request_info(connection);
  return {plain_address(info->remote_addr), info->remote_port};
}

}  // namespace

HttpAnswer error_answer(int status, const std::string& sentence) {
  HttpAnswer answer;
  answer.status = status;
  answer.body =
      nlohmann::json{{"error", sentence}}.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  return answer;
}

struct WebServer::Implementation {
  Implementation(const Options& wanted, Handlers all)
      : handlers(std::move(all)), book(wanted.seats), options(wanted) {}

  static Implementation& of(const mg_connection* connection) {
    return *static_cast<Implementation*>(mg_get_user_context_data(connection));
  }

  void start();
  bool listen_on(const std::string& where);
  int begin(mg_connection* connection);
  int open_socket(mg_connection* connection, Connection& kept, const HttpRequest& request);
  HttpAnswer answer(mg_connection* connection, Connection& kept, HttpRequest& request);
  void serve(mg_connection* connection);
  void stop();

  Handlers handlers;
  ConnectionBook book;
  Options options;
  std::atomic<bool> stopping{false};
  mg_context* context = nullptr;
  std::mutex message_mutex;
  std::string trouble;  ///< what civetweb says while it starts
  int port = 0;
};

void WebServer::Implementation::start() {
  mg_init_library(MG_FEATURES_DEFAULT);  // no TLS
  const std::string port_text = std::to_string(options.port);
  const bool listens = options.bind.empty() ? listen_on('+' + port_text) || listen_on(port_text)
                       : options.bind.find(':') != std::string::npos
                           ? listen_on('[' + options.bind + "]:" + port_text)
                           : listen_on(options.bind + ':' + port_text);
  if (!listens) {
    mg_exit_library();
    const bool taken = trouble.find(std::strerror(EADDRINUSE)) != std::string::npos;
    throw std::runtime_error(
        taken
            ? "port " + port_text + " is taken; --port N serves on another one, --port 0 on any that is free"
            : "cannot serve on port " + port_text + ": " + trouble);
  }
  mg_server_port ports[4] = {};
  if (mg_get_server_ports(context, 4, ports) > 0) port = ports[0].port;
  book.set_port(port);
}

bool WebServer::Implementation::listen_on(const std::string& where) {
  mg_callbacks callbacks{};
  callbacks.begin_request = [](mg_connection* c) {
    int status = 503;
    with_room([&] { status = of(c).begin(c); });
    return status;
  };
  callbacks.init_connection = [](const mg_connection* c, void**) {
    of(c).book.look();  // who it is is not told yet
    return 0;
  };
  callbacks.connection_close = [](const mg_connection* c) { of(c).book.begin_close(peer_of(c)); };
  callbacks.connection_closed = [](const mg_connection* c) { of(c).book.closed(peer_of(c)); };
  callbacks.http_error = [](mg_connection* c, int status, const char* message) {
    write_answer(c, error_answer(status, message), false);
    return 0;
  };
  callbacks.log_message = [](const mg_connection* c, const char* message) {
    if (c == nullptr) return 1;
    Implementation& self = of(c);
    const std::lock_guard lock(self.message_mutex);
    if (self.context == nullptr) self.trouble += (self.trouble.empty() ? "" : "; ") + std::string(message);
    return 1;
  };
  const std::string threads = std::to_string(options.seats.seats);
  const char* settings[] = {"listening_ports",
                            where.c_str(),
                            "num_threads",
                            threads.c_str(),
                            "request_timeout_ms",
                            kRequestTimeoutMs,
                            "enable_keep_alive",
                            "no",
                            "tcp_nodelay",
                            "1",
                            "max_request_size",
                            "16384",
                            "linger_timeout_ms",
                            "-2",
                            "listen_backlog",
                            "1024",
                            nullptr};
  mg_context* started = mg_start(&callbacks, this, settings);
  if (started == nullptr) return false;
  mg_set_websocket_handler(
      started, kSockets, [](const mg_connection*, void*) { return 0; },
      [](mg_connection* c, void*) { with_room([&] { of(c).serve(c); }); },
      [](mg_connection*, int, char*, std::size_t, void*) { return 0; }, nullptr, nullptr);
  const std::lock_guard lock(message_mutex);
  context = started;
  return true;
}

/// Called first for each request, that for a WebSocket too: 0 lets civetweb go on with its handshake.
int WebServer::Implementation::begin(mg_connection* connection) {
  Connection* kept = book.find(peer_of(connection));
  if (kept == nullptr) return 503;  // cut already
  HttpRequest request = head_of(connection);
  if (is_upgrade(request)) return open_socket(connection, *kept, request);
  const HttpAnswer reply = answer(connection, *kept, request);
  if (reply.file.empty()) {
    if (reply.body.size() > kLongBody) book.use(*kept, Seats::Use::kDownload);
    write_answer(connection, reply, request.method == "HEAD");
  } else {
    book.use(*kept, Seats::Use::kDownload);
    return write_file(connection, reply, request.method == "HEAD");
  }
  return reply.status;
}

HttpAnswer WebServer::Implementation::answer(mg_connection* connection, Connection& kept,
                                             HttpRequest& request) {
  const Seats::Use use = handlers.use(request);
  if (!book.use(kept, use)) return error_answer(503, "too many clients; try again in a moment");
  // Stopping needs no body, and waits for none.
  if (use != Seats::Use::kStop && !read_body(connection, request))
    return error_answer(413, "the request is too long");
  try {
    return handlers.answer(request);
  } catch (const std::exception& e) {
    return error_answer(500, e.what());
  }
}

int WebServer::Implementation::open_socket(mg_connection* connection, Connection& kept,
                                           const HttpRequest& request) {
  HttpAnswer refusal = error_answer(503, "too many clients; try again in a moment");
  if (book.use(kept, handlers.use(request))) {
    try {
      auto opened = handlers.open(request);
      if (auto* channel = std::get_if<std::unique_ptr<Channel>>(&opened)) {
        kept.channel = std::move(*channel);
        return 0;
      }
      refusal = std::get<HttpAnswer>(opened);
    } catch (const std::exception& e) {
      refusal = error_answer(500, e.what());
    }
  }
  write_answer(connection, refusal, false);
  return refusal.status;
}

/// In the connection's thread, once the handshake is done and until the WebSocket is closed.
void WebServer::Implementation::serve(mg_connection* connection) {
  Connection* kept = book.find(peer_of(connection));
  if (kept == nullptr || !kept->channel) return;
  WsSession session(kept->socket, *kept->channel);
  try {
    session.run(stopping);
  } catch (const std::exception&) {
    // Memory has run out, it may be: this client is lost, and nobody else.
  }
  kept->channel.reset();  // first of all, as the robot stops when its driver is gone
  session.farewell();
}

void WebServer::Implementation::stop() {
  stopping = true;
  book.end_all();
  // civetweb looks up from waiting for connections every two seconds, or when there is one.
  std::atomic<bool> stopped{false};
  std::thread knocks([&] {
    while (!stopped) {
      knock(port);
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  });
  mg_stop(context);
  stopped = true;
  knocks.join();
  mg_exit_library();
}

WebServer::WebServer(const Options& options, Handlers handlers)
    : implementation_(std::make_unique<Implementation>(options, std::move(handlers))) {
  implementation_->start();
}
WebServer::~WebServer() { implementation_->stop(); }

bool WebServer::answers_ipv6() { return mg_check_feature(MG_FEATURES_IPV6) != 0; }

int WebServer::port() const { return implementation_->port; }
std::size_t WebServer::connections() const { return implementation_->book.taken(); }
std::uint64_t WebServer::refused() const { return implementation_->book.refused(); }

}  // namespace dynslam

/// Stands before the C library's. civetweb asks for stacks of 100 KiB, of which the libraries that are linked
/// take 60 for their thread-local variables; an error page of its own (an upgrade without a key is enough)
/// ran over what was left, and took the whole program with it. Memory it is only once it is used.
extern "C" int pthread_attr_setstacksize(pthread_attr_t* attributes, std::size_t size) noexcept {
  using Set = int (*)(pthread_attr_t*, std::size_t);
  constexpr std::size_t kLeast = std::size_t{512} * 1024;
  static const auto kSet = reinterpret_cast<Set>(dlsym(RTLD_NEXT, "pthread_attr_setstacksize"));
  return kSet != nullptr ? kSet(attributes, std::max(size, kLeast)) : ENOSYS;
}
