// SPDX-License-Identifier: MIT
// The server on a real port, and its clients as bare sockets.
#include "server/server.h"

#include <future>
#include <thread>

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "server/ws_session.h"

namespace dynslam {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// A client's end of a connection. Reads for ten seconds at most.
class Client {
 public:
  explicit Client(int port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
    const timeval patience{10, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
  }
  ~Client() { close(socket_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void say(const std::string& bytes) const { send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL); }
  /// What comes until the server closes, or until `end` was read.
  std::string hear(const std::string& end = {}) const {
    std::string heard;
    char bytes[4096];
    while (end.empty() || heard.find(end) == std::string::npos) {
      const ssize_t n = recv(socket_, bytes, sizeof(bytes), 0);
      if (n <= 0) break;
      heard.append(bytes, static_cast<std::size_t>(n));
    }
    return heard;
  }

 private:
  int socket_;
};

class ServerTest : public testing::Test {
 protected:
  static ServerConfig config() {
    ServerConfig config;
    config.port = 0;
    config.seats = 16;
    config.seats_kept = 4;
    config.seats_per_address = 12;
    return config;
  }
  std::string ask(const std::string& request) const {
    const Client client(server.port());
    client.say(request);
    return client.hear();
  }
  std::string get(const std::string& path, const std::string& headers = {}) const {
    return ask("GET " + path + " HTTP/1.1\r\nHost: localhost\r\n" + headers + "\r\n");
  }
  std::string upgrade(const std::string& kind, const std::string& headers = {}) const {
    return "GET /api/v1/ws/" + kind +
           " HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: "
           "Upgrade\r\nSec-WebSocket-Version: "
           "13\r\n"
           "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
           headers + "\r\n";
  }

  Ports ports;
  RunningClock clock;
  Access access{{{}, "robot", std::nullopt, true, {"127.0.0.1/8"}}};
  NoteBook notes{ports.map_notes, "m", std::nullopt};
  Server server{ports, clock, access, notes, config(), {"1", "{}", {}, {}, {}, {}}};
};

TEST_F(ServerTest, AnswersWithHeadersThatKeepBrowsersSafe) {
  const std::string page = get("/");
  EXPECT_THAT(page, StartsWith("HTTP/1.1 200 OK\r\n"));
  for (const char* header : {"X-Content-Type-Options: nosniff", "default-src 'none'",
                             "frame-ancestors 'none'", "Content-Type: text/html", "<title>dynslam</title>"})
    EXPECT_THAT(page, HasSubstr(header));
  EXPECT_THAT(get("/page.js"), HasSubstr("text/javascript"));
  EXPECT_THAT(get("/page.css"), HasSubstr("text/css"));
  const std::string head = ask("HEAD / HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_THAT(head, testing::EndsWith("\r\n\r\n"));
}

TEST_F(ServerTest, AnswersNonsenseInTheSameForm) {
  EXPECT_THAT(get("/../../etc/passwd"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(get("/%2e%2e/%2e%2e/etc/passwd"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(get("/page.js%00.html"), HasSubstr("HTTP/1.1 "));
  EXPECT_THAT(get("/", "X: " + std::string(20000, 'x') + "\r\n"), StartsWith("HTTP/1.1 4"));
  EXPECT_THAT(ask("\x16\x03\x01 TLS\r\n\r\n"), HasSubstr("{\"error\":"));
  EXPECT_THAT(ask("POST /api/v1/mode HTTP/1.1\r\nHost: localhost\r\nContent-Length: 20000\r\n\r\n"),
              StartsWith("HTTP/1.1 413"));
  EXPECT_THAT(ask("BREW / HTTP/1.1\r\nHost: localhost\r\n\r\n"), HasSubstr("\"error\""));
}

TEST_F(ServerTest, TakesBodiesWithAndWithoutALength) {
  const std::string body = R"({"power_limit":0.5})";
  const std::string head =
      "POST /api/v1/power_limit HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n";
  EXPECT_THAT(ask(head + "Content-Length: 19\r\n\r\n" + body), StartsWith("HTTP/1.1 204"));
  EXPECT_EQ(ports.power_limit, 0.5);
  EXPECT_THAT(ask(head + "Transfer-Encoding: chunked\r\n\r\n13\r\n" + body + "\r\n0\r\n\r\n"),
              StartsWith("HTTP/1.1 204"));
}

TEST_F(ServerTest, OpensOnlyTheSocketsThatThereAre) {
  EXPECT_THAT(ask(upgrade("nothing")), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(ask(upgrade("map", "Authorization: Bearer nobody\r\n")), StartsWith("HTTP/1.1 401"));
  EXPECT_THAT(get("/api/v1/ws/map"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(ask("GET /api/v1/ws/map HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: "
                  "Upgrade\r\n\r\n"),
              StartsWith("HTTP/1.1 400"));
  const Client client(server.port());
  client.say(upgrade("state"));
  EXPECT_THAT(client.hear("\"watchers\""), HasSubstr("s3pPLMBiTxaQ9kYGzzhZRbK+xOo="));
  client.say("\x81\x05hello");
  EXPECT_THAT(client.hear(), HasSubstr("a client masks its frames"));
}

TEST_F(ServerTest, AnAddressGetsItsShareAndStopIsAlwaysHeard) {
  std::vector<std::unique_ptr<Client>> idle;
  for (int i = 0; i < 30; ++i) idle.push_back(std::make_unique<Client>(server.port()));
  for (int i = 0; i < 20 && !ports.stops.size(); ++i)
    ask("POST /api/v1/stop HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0\r\n\r\n");
  EXPECT_FALSE(ports.stops.try_pop()) << "the share is taken; another address would be heard";
  idle.resize(4);
  std::string answer;
  for (int i = 0; i < 200 && answer.empty(); ++i) {
    answer = ask("POST /api/v1/stop HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0\r\n\r\n");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 204"));
  EXPECT_TRUE(ports.stops.try_pop());
}

TEST_F(ServerTest, APortThatIsTakenIsSaidInOneLine) {
  ServerConfig second = config();
  second.port = server.port();
  try {
    Server another(ports, clock, access, notes, second, {});
    FAIL() << "two servers on one port";
  } catch (const std::runtime_error& e) {
    EXPECT_EQ(std::string(e.what()),
              "port " + std::to_string(second.port) +
                  " is taken; --port N serves on another one, --port 0 on any that is free");
  }
}

TEST_F(ServerTest, EndsWhileClientsAreThere) {
  std::optional<Server> other;
  other.emplace(ports, clock, access, notes, config(), ServerFacts());
  const Client idle(other->port()), watching(other->port()), driving(other->port());
  watching.say(upgrade("video"));
  watching.hear("\r\n\r\n");
  driving.say(upgrade("control"));
  driving.hear("wheel");
  other.reset();
  EXPECT_THAT(driving.hear(), HasSubstr("the robot's program ends"));
  EXPECT_EQ(ports.watchers, 0);
}

/// Sends what it is told, and keeps what it hears.
struct EchoChannel : Channel {
  std::vector<WsMessage> heard;
  std::size_t to_send = 0;  ///< messages of a megabyte
  std::size_t longest_message() const override { return 100; }
  std::optional<WsClosing> take(const WsMessage& message, SteadyTime) override {
    heard.push_back(message);
    if (message.payload == "more") to_send = 100;
    return std::nullopt;
  }
  std::optional<WsMessage> next(SteadyTime) override {
    if (to_send == 0) return std::nullopt;
    --to_send;
    return WsMessage{WsOpcode::kBinary, std::string(1 << 20, 'x')};
  }
  SteadyTime due() const override { return SteadyTime::max(); }
};

class WsSessionTest : public testing::Test {
 protected:
  WsSessionTest() {
    int ends[2];
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
    mine = ends[0];
    its = ends[1];
    session = std::thread([this] {
      WsSession serves(its, channel);
      serves.run(stopping);
      serves.farewell();
    });
  }
  ~WsSessionTest() override {
    shutdown(mine, SHUT_RDWR);
    if (session.joinable()) session.join();
    close(mine);
    close(its);
  }
  void say(const std::string& bytes) const { send(mine, bytes.data(), bytes.size(), MSG_NOSIGNAL); }
  std::string hear(std::size_t n) const {
    std::string heard(n, '\0');
    const ssize_t got = recv(mine, heard.data(), n, MSG_WAITALL);
    heard.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    return heard;
  }
  /// Masked with zeros.
  static std::string frame(char first, const std::string& payload) {
    return std::string(1, first) + static_cast<char>(0x80U | payload.size()) + std::string(4, '\0') + payload;
  }

  int mine = -1, its = -1;
  EchoChannel channel;
  std::atomic<bool> stopping{false};
  std::thread session;
};

TEST_F(WsSessionTest, AnswersPingsAndClosesPolitely) {
  say(frame('\x81', "hi") + frame('\x89', "abc"));
  EXPECT_EQ(hear(5),
            "\x8a\x03"
            "abc");
  say(frame('\x8a', "") + frame('\x88', ""));
  EXPECT_EQ(hear(100), std::string("\x88\x02\x03\xe8"));
  session.join();
  ASSERT_EQ(channel.heard.size(), 1U);
  EXPECT_EQ(channel.heard[0].payload, "hi");
}

TEST_F(WsSessionTest, CutsWhoSaysTooMuch) {
  say(frame('\x81', std::string(101, 'a')));
  EXPECT_THAT(hear(200), HasSubstr("the message is too long"));
  session.join();
  EXPECT_TRUE(channel.heard.empty());
}

TEST_F(WsSessionTest, HearsAClientThatDoesNotListen) {
  say(frame('\x81', "more"));
  hear(100);
  say(frame('\x81', "still here"));
  for (int i = 0; i < 1000 && hear(10000).size() == 10000; ++i) {
    // half of what is to come is never read
  }
  shutdown(mine, SHUT_RDWR);
  session.join();
  EXPECT_EQ(channel.heard.size(), 2U);
  EXPECT_GT(channel.to_send, 80U) << "nothing was queued";
}

TEST_F(WsSessionTest, EndsWhenAsked) {
  say(frame('\x89', ""));
  EXPECT_EQ(hear(2).size(), 2U);
  stopping = true;
  say(frame('\x8a', ""));
  EXPECT_THAT(hear(100), HasSubstr("the robot's program ends"));
}

}  // namespace
}  // namespace dynslam
