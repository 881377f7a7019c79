// SPDX-License-Identifier: MIT
#include "server/api.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/fixed_gate.h"
#include "server/state_json.h"

namespace dynslam {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

class ApiTest : public testing::Test {
 protected:
  ApiTest() { api.add_to(routes); }
  HttpAnswer ask(const std::string& method, const std::string& path, const std::string& body = {}) {
    return test::ask(routes, method, path, body);
  }
  int status(const std::string& path, const std::string& body) { return ask("POST", path, body).status; }
  void draw_map() {
    ChunkedGrid grid(0.05);
    for (int i = 0; i < 5; ++i) grid.add_hit({10, 10});
    WorldState world;
    world.map = grid.snapshot();
    world.pose.quality = 0.5;
    ports.world.put(world);
  }

  Ports ports;
  SteppedClock clock{time_at_s(3)};
  test::FixedGate gate{Role::kAdmin};
  EventCounters events;
  Wheel wheel{ports, clock, {}};
  NoteBook notes{ports.map_notes, "20261126-144501", std::nullopt};
  Api api{ports,
          clock,
          gate,
          wheel,
          notes,
          events,
          {"1.2.3", R"({"slam":{"cell_size_m":0.02}})", {"flat", "hall"}, "flat", {}, {}, {}}};
  RouteTable routes;
};

TEST_F(ApiTest, KnowsWhatIsThereAndWhatMayBeDoneWithIt) {
  EXPECT_EQ(ask("GET", "/healthz").status, 200);
  EXPECT_EQ(ask("HEAD", "/healthz").status, 200);
  EXPECT_EQ(ask("GET", "/health").status, 404);
  EXPECT_EQ(ask("GET", "/healthz/").status, 404);
  const HttpAnswer answer = ask("DELETE", "/api/v1/state");
  EXPECT_EQ(answer.status, 405);
  EXPECT_EQ(answer.headers.at(0), (std::pair<std::string, std::string>{"Allow", "GET"}));
  EXPECT_THAT(json::parse(answer.body)["error"].get<std::string>(), HasSubstr("DELETE"));
}

TEST_F(ApiTest, AsksTheGateForEachRequest) {
  const std::vector<std::tuple<const char*, const char*, Role>> needs = {
      {"GET", "/healthz", Role::kNone},
      {"GET", "/metrics", Role::kViewer},
      {"GET", "/api/v1/openapi.yaml", Role::kViewer},
      {"GET", "/api/v1/state", Role::kViewer},
      {"GET", "/api/v1/devices", Role::kViewer},
      {"GET", "/api/v1/config", Role::kViewer},
      {"GET", "/api/v1/worlds", Role::kViewer},
      {"GET", "/api/v1/graph", Role::kViewer},
      {"GET", "/api/v1/log", Role::kViewer},
      {"GET", "/api/v1/map.png", Role::kViewer},
      {"GET", "/api/v1/map.pgm", Role::kViewer},
      {"GET", "/api/v1/map.yaml", Role::kViewer},
      {"POST", "/api/v1/goal", Role::kDriver},
      {"POST", "/api/v1/mode", Role::kDriver},
      {"POST", "/api/v1/power_limit", Role::kDriver},
      {"POST", "/api/v1/stop", Role::kNone},
      {"POST", "/api/v1/clear_stop", Role::kDriver}};
  for (const auto& [method, path, needed] : needs) {
    for (const Role right : {Role::kNone, Role::kViewer, Role::kDriver, Role::kAdmin}) {
      gate.right = right;
      EXPECT_EQ(ask(method, path).status == 403, right < needed) << path << ' ' << static_cast<int>(right);
    }
  }
}

TEST_F(ApiTest, TellsAboutTheProgram) {
  EXPECT_EQ(json::parse(ask("GET", "/healthz").body)["version"], "1.2.3");
  EXPECT_EQ(json::parse(ask("GET", "/api/v1/config").body)["slam"]["cell_size_m"], 0.02);
  EXPECT_EQ(json::parse(ask("GET", "/api/v1/worlds").body),
            (json{{"worlds", {"flat", "hall"}}, {"current", "flat"}}));
  EXPECT_THAT(ask("GET", "/api/v1/openapi.yaml").body, StartsWith("openapi: 3.1"));
}

TEST_F(ApiTest, GivesTheMapInEachFormAlsoWhenThereIsNone) {
  for (const bool drawn : {false, true}) {
    if (drawn) draw_map();
    EXPECT_THAT(ask("GET", "/api/v1/map.png").body, StartsWith("\x89PNG"));
    EXPECT_THAT(ask("GET", "/api/v1/map.pgm").body, StartsWith("P5"));
    EXPECT_THAT(ask("GET", "/api/v1/map.yaml").body, HasSubstr("image: map.pgm"));
  }
}

TEST_F(ApiTest, LooksAtAGoalClosely) {
  draw_map();
  const char* path = "/api/v1/goal";
  EXPECT_EQ(ask("POST", path).status, 415);
  EXPECT_EQ(status(path, "{"), 400);
  EXPECT_EQ(status(path, "[1,2]"), 400);
  EXPECT_EQ(status(path, R"({"x_m":1})"), 422);
  EXPECT_EQ(status(path, R"({"x_m":"1","y_m":1})"), 422);
  EXPECT_EQ(status(path, R"({"x_m":1,"y_m":NaN})"), 400);
  EXPECT_EQ(status(path, R"({"x_m":1,"y_m":1e999})"), 400);
  EXPECT_EQ(status(path, R"({"x_m":1,"y_m":1,"yaw_rad":null})"), 422);
  EXPECT_EQ(status(path, R"({"x_m":1,"y_m":1,"fast":true})"), 422);
  EXPECT_EQ(status(path, R"({"x_m":100,"y_m":1})"), 422) << "off the map";
  EXPECT_EQ(status(path, R"({"x_m":-1e300,"y_m":1})"), 422);
  EXPECT_EQ(status(path, R"({"x_m":1,"y_m":1,"yaw_rad":3})"), 501);
  EXPECT_EQ(status("/api/v1/mode", R"({"mode":"explore"})"), 501);
  EXPECT_EQ(status("/api/v1/mode", R"({"mode":"manual"})"), 204);
  EXPECT_EQ(status("/api/v1/mode", R"({"mode":"dance"})"), 422);
  EXPECT_EQ(status("/api/v1/mode", R"({"mode":3})"), 422);
}

TEST_F(ApiTest, SetsThePowerLimit) {
  const char* path = "/api/v1/power_limit";
  EXPECT_EQ(status(path, R"({"power_limit":0.25})"), 204);
  EXPECT_EQ(ports.power_limit, 0.25);
  for (const char* body :
       {R"({"power_limit":-0.1})", R"({"power_limit":1.1})", R"({"power_limit":"1"})", "{}"})
    EXPECT_EQ(status(path, body), 422) << body;
  EXPECT_EQ(ports.power_limit, 0.25);
}

TEST_F(ApiTest, StopsAndClears) {
  EXPECT_EQ(ask("POST", "/api/v1/stop").status, 204);
  EXPECT_EQ(ports.stops.try_pop(), "Ada");
  EXPECT_EQ(ask("POST", "/api/v1/clear_stop").status, 204);
  EXPECT_TRUE(ports.clear_asked);
}

TEST_F(ApiTest, GivesOrdersToAnAutopilot) {
  draw_map();
  ports.autopilot.put(AutopilotStatus{});
  ASSERT_FALSE(notes.put_place({{1.0, 2.0}, 0.5, "Kitchen"}));
  EXPECT_EQ(status("/api/v1/goal", R"({"x_m":1,"y_m":0.5,"yaw_rad":0.5,"name":"Sofa"})"), 204);
  EXPECT_EQ(std::get<GoThere>(*ports.orders.try_pop()).to, (Destination{{1.0, 0.5}, 0.5, "Sofa"}));
  EXPECT_EQ(status("/api/v1/goal", R"({"x_m":1,"y_m":0.5,"name":""})"), 204);
  EXPECT_EQ(std::get<GoThere>(*ports.orders.try_pop()).to, (Destination{{1.0, 0.5}, {}, ""}));
  EXPECT_EQ(status("/api/v1/goal", R"({"x_m":1,"y_m":0.5,"name":"a\nb"})"), 422);
  const auto order = [&](const std::string& body) {
    EXPECT_EQ(status("/api/v1/mode", body), 204) << body;
    return ports.orders.try_pop().value();
  };
  EXPECT_TRUE(std::holds_alternative<SwitchOff>(order(R"({"mode":"manual"})")));
  EXPECT_TRUE(std::holds_alternative<StandBy>(order(R"({"mode":"navigate"})")));
  EXPECT_TRUE(std::holds_alternative<Explore>(order(R"({"mode":"explore"})")));
  EXPECT_TRUE(std::holds_alternative<GoHome>(order(R"({"mode":"home"})")));
  const Order patrol = order(R"({"mode":"patrol","places":["Kitchen","Kitchen"]})");
  EXPECT_EQ(std::get<Patrol>(patrol).stops,
            (std::vector<Destination>(2, Destination{{1.0, 2.0}, 0.5, "Kitchen"})));
  for (const char* body :
       {R"({"mode":"patrol"})", R"({"mode":"patrol","places":[]})", R"({"mode":"patrol","places":["Attic"]})",
        R"({"mode":"patrol","places":"Kitchen"})", R"({"mode":"patrol","places":[1]})",
        R"({"mode":"home","places":["Kitchen"]})"})
    EXPECT_EQ(status("/api/v1/mode", body), 422) << body;
  EXPECT_FALSE(ports.orders.try_pop());
}

TEST_F(ApiTest, TakesNoOrdersWhileSomebodyElseSteers) {
  draw_map();
  ports.autopilot.put(AutopilotStatus{});
  const auto now = std::chrono::steady_clock::now();
  const auto bob = wheel.enter();
  wheel.acquire(bob, "Bob", false, now, "bob's phone");
  const char* explore = R"({"mode":"explore"})";
  EXPECT_EQ(status("/api/v1/mode", explore), 204) << "he only looks on";
  wheel.drive(bob, {0.1, 0.0});
  const HttpAnswer refusal = ask("POST", "/api/v1/mode", explore);
  EXPECT_EQ(refusal.status, 409);
  EXPECT_THAT(refusal.body, HasSubstr("Bob is driving"));
  EXPECT_EQ(status("/api/v1/goal", R"({"x_m":1,"y_m":0.5})"), 409);
  EXPECT_EQ(ports.orders.size(), 1U);
  wheel.release(bob);
  EXPECT_EQ(status("/api/v1/mode", explore), 204);
}

TEST_F(ApiTest, StateSaysHowItStandsWithTheAutopilot) {
  EXPECT_EQ(json::parse(api.state_text())["map_id"], "20261126-144501");
  AutopilotStatus status;
  ports.autopilot.put(status);
  EXPECT_TRUE(json::parse(api.state_text())["autopilot"].is_null()) << "people drive";
  EXPECT_EQ(json::parse(api.state_text())["mode"], "manual");
  status.phase = AutopilotPhase::kStopped;
  status.mode = AutopilotMode::kExploration;
  status.reason = "the way is blocked";
  status.goal = Destination{{1.0, 2.0}, {}, "Kitchen"};
  status.remaining_m = 3.25;
  status.nearest_map = Vector2(1.0, 1.5);
  for (int i = 0; i <= 1000; ++i) status.route_map.emplace_back(0.1 * i, 0.0);
  for (int i = 0; i < 100; ++i) status.places.push_back({"frontier", {1.0 * i, 0.0}});
  ports.autopilot.put(status);
  const json state = json::parse(api.state_text());
  EXPECT_EQ(state["mode"], "explore");
  json a = state["autopilot"];
  ASSERT_EQ(a["route"].size(), 200U);
  EXPECT_EQ(a["route"].front(), (json{0.0, 0.0}));
  EXPECT_EQ(a["route"].back(), (json{100.0, 0.0})) << "both ends stay";
  ASSERT_EQ(a["places"].size(), 64U);
  EXPECT_EQ(a["places"][1], (json{{"kind", "frontier"}, {"x_m", 1.0}, {"y_m", 0.0}}));
  a.erase("route");
  a.erase("places");
  EXPECT_EQ(a, (json{{"mode", "explore"},
                     {"phase", "stopped"},
                     {"reason", "the way is blocked"},
                     {"goal", {{"x_m", 1.0}, {"y_m", 2.0}, {"name", "Kitchen"}}},
                     {"remaining_m", 3.25},
                     {"nearest", {1.0, 1.5}}}));
  EXPECT_THAT(ask("GET", "/metrics").body, HasSubstr("dynslam_autopilot_phase 3\n"));
}

TEST_F(ApiTest, StateIsWholeFromTheBeginning) {
  const json empty = json::parse(ask("GET", "/api/v1/state").body);
  for (const char* part :
       {"pose", "verdict", "scan", "battery", "attitude", "collision", "driver", "recording"})
    EXPECT_TRUE(empty.at(part).is_null()) << part;
  draw_map();
  DriveState drive;
  drive.verdict = {Motion::kHold, "\xff is no UTF-8"};
  drive.battery.level = BatteryLevel::kLow;
  ports.drive.put(drive);
  Scan scan;
  scan.beams = {{0.0F, 1.0F, 0.0F}, {1.5708F, 2.0F, 0.0F}, {0.001F, 0.5F, 0.0F}};
  ports.scan.put(scan);
  const json state = json::parse(ask("GET", "/api/v1/state").body);
  EXPECT_EQ(state["pose"]["quality"], 0.5);
  EXPECT_EQ(state["verdict"]["motion"], "hold");
  EXPECT_EQ(state["battery"]["level"], "low");
  EXPECT_EQ(state["scan"]["seq"], 1);
  EXPECT_EQ(state["scan"]["ranges_cm"][0], 50) << "the nearer one";
  EXPECT_EQ(state["scan"]["ranges_cm"][90], 200);
  EXPECT_EQ(state["scan"]["ranges_cm"][180], 0);
}

TEST_F(ApiTest, StateSaysHowSureThePoseIsAndWhatMovesTheRobot) {
  WorldState world;
  world.pose.covariance << 1.5e-6, -2e-7, 0, -2e-7, 3e-6, 0, 0, 0, std::nan("");
  world.pose.unsteady = Unsteady::kTilting;
  ports.world.put(world);
  DriveState drive;
  drive.verdict = {Motion::kStop, "tilted"};
  drive.cause = Cause::kTilt;
  drive.attitude = Attitude{0.5, -0.25, 1.0};
  drive.collision = true;
  ports.drive.put(drive);
  const json state = json::parse(ask("GET", "/api/v1/state").body);
  EXPECT_EQ(state["pose"]["covariance"],
            (json{{"xx_m2", 1.5e-6}, {"xy_m2", -2e-7}, {"yy_m2", 3e-6}, {"yaw_rad2", 1e6}}));
  EXPECT_EQ(state["pose"]["unsteady"], "tilting");
  EXPECT_EQ(state["verdict"]["cause"], "tilt");
  EXPECT_EQ(state["attitude"], (json{{"roll_rad", 0.5}, {"pitch_rad", -0.25}, {"yaw_radps", 1.0}}));
  EXPECT_EQ(state["collision"], true);
}

TEST(Cause, HasTheWordsOfTheContract) {
  EXPECT_STREQ(to_string(Cause::kNone), "none");
  EXPECT_STREQ(to_string(Cause::kPinsSilent), "pins");
  EXPECT_STREQ(to_string(Cause::kMotorFault), "motor-fault");
  EXPECT_STREQ(to_string(Cause::kDriver), "driver");
  EXPECT_STREQ(to_string(Cause::kBattery), "battery");
}

TEST_F(ApiTest, DrawsTheGraph) {
  EXPECT_EQ(json::parse(ask("GET", "/api/v1/graph").body),
            (json{{"local_maps", json::array()}, {"closures", json::array()}}));
  ports.graph.put(GraphView{{{3, {1.0, 2.0, 0.5}}, {7, {1.5, 2.0, 0.0}}}, {{3, 7}}});
  const json graph = json::parse(ask("GET", "/api/v1/graph").body);
  ASSERT_EQ(graph["local_maps"].size(), 2U);
  EXPECT_EQ(graph["local_maps"][0], (json{{"id", 3}, {"x_m", 1.0}, {"y_m", 2.0}, {"yaw_rad", 0.5}}));
  EXPECT_EQ(graph["closures"], (json::array({{{"from", 3}, {"to", 7}}})));
}

TEST_F(ApiTest, TellsTheLastLinesOfTheLog) {
  EXPECT_EQ(json::parse(ask("GET", "/api/v1/log").body), (json{{"lines", json::array()}}));
  for (int i = 0; i < 300; ++i) ports.recent_log.push({time_at_s(i), LogLevel::kInfo, std::to_string(i)});
  ports.recent_log.push({time_at_s(300), LogLevel::kFatal, "\xff is no UTF-8"});
  const json lines = json::parse(ask("GET", "/api/v1/log").body)["lines"];
  ASSERT_EQ(lines.size(), 200U);
  EXPECT_EQ(lines[0], (json{{"t_s", 101.0}, {"level", "info"}, {"text", "101"}}));
  EXPECT_EQ(lines[199]["level"], "fatal");
}

TEST(CoarseRanges, AreSeenFromTheRobotAndLeaveOutWhatIsNone) {
  Scan scan;
  scan.mount.robot_T_lidar = {0.0, 0.5, 0.0};
  scan.mount.upside_down = true;
  scan.beams = {{-1.5707963F, 1.0F, 0.0F},
                {0.0F, std::numeric_limits<float>::infinity(), 0.0F},
                {0.3F, std::numeric_limits<float>::quiet_NaN(), 0.0F},
                {0.5F, 1e6F, 0.0F}};
  const auto ranges = coarse_ranges_cm(scan);
  EXPECT_EQ(ranges[90], 150);
  int returns = 0;
  for (const auto cm : ranges) returns += cm > 0 ? 1 : 0;
  EXPECT_EQ(returns, 1);
}

TEST_F(ApiTest, MetricsAndDevicesNameWhatIsWrong) {
  draw_map();
  ports.drive.put(DriveState{});
  DeviceHealth lidar{true, 12, 3, time_at_s(2), "it \"hangs\"\n", "a lidar of \"ours\""};
  lidar.counters.add("bad-checksums", 5);
  ports.lidar_health.put(lidar);
  Counters slam;
  slam.add("front_end.no_match", 4);
  ports.slam_counters.put(slam);
  events.add("server.stops");
  const std::string text = ask("GET", "/metrics").body;
  for (const char* line :
       {"dynslam_device_errors_total{device=\"lidar\"} 3\n", "dynslam_device_ok{device=\"lidar\"} 0\n",
        "dynslam_events_total{event=\"front_end.no_match\"} 4\n",
        "dynslam_events_total{event=\"lidar.bad-checksums\"} 5\n",
        "dynslam_events_total{event=\"server.stops\"} 1\n", "dynslam_pose_quality 0.5\n",
        "dynslam_verdict 3\n", "dynslam_command_to_motor_seconds_count 0\n", "dynslam_connections 0\n"})
    EXPECT_THAT(text, HasSubstr(line));
  const json devices = json::parse(ask("GET", "/api/v1/devices").body);
  EXPECT_EQ(devices["devices"]["lidar"]["errors"], 3);
  EXPECT_EQ(devices["devices"]["camera"]["present"], false);
  EXPECT_EQ(devices["devices"]["lidar"]["about"], "a lidar of \"ours\"");
  EXPECT_EQ(devices["counters"]["front_end.no_match"], 4);
  EXPECT_EQ(devices["counters"]["lidar.bad-checksums"], 5);
}

TEST(RouteTable, TakesOneNameOutOfAPath) {
  RouteTable routes;
  routes.add("GET", "/r/{}/file", [](const HttpRequest&, const std::string& name) {
    HttpAnswer answer;
    answer.body = name;
    return answer;
  });
  const auto ask = [&](const std::string& path) { return routes.answer({"GET", path, {}, {}, {}, {}}); };
  EXPECT_EQ(ask("/r/a.mcap/file").body, "a.mcap");
  for (const char* path : {"/r//file", "/r/file", "/r/a/b/file", "/r/a/files", "/r/../../file"})
    EXPECT_EQ(ask(path).status, 404) << path;
}

TEST(DelayHistogram, CountsInCumulativeBuckets) {
  DelayHistogram delays;
  delays.add(std::chrono::milliseconds(12));
  delays.add(std::chrono::milliseconds(500));
  const std::string text = delays.text("x_seconds", "of x");
  for (const char* line :
       {"# TYPE dynslam_x_seconds histogram\n", "_bucket{le=\"0.01\"} 0\n", "_bucket{le=\"0.015\"} 1\n",
        "_bucket{le=\"0.2\"} 1\n", "_bucket{le=\"+Inf\"} 2\n", "_sum 0.512\n", "_count 2\n"})
    EXPECT_THAT(text, HasSubstr(line));
}

}  // namespace
}  // namespace dynslam
