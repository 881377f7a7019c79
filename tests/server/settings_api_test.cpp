// SPDX-License-Identifier: MIT
#include "server/settings_api.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/fixed_gate.h"

namespace dynslam {
namespace {

using nlohmann::json;

ServerFacts facts(const std::string& name) {
  ServerFacts all;
  all.name = name;
  all.trusted_range_least_m = 0.15;
  all.trusted_range_most_m = 80.0;
  return all;
}

class SettingsApiTest : public testing::Test {
 protected:
  SettingsApiTest() {
    ports.trusted_range_m = 12.0;
    api.add_to(routes);
  }
  HttpAnswer ask(const std::string& method, const std::string& body = {}) {
    return test::ask(routes, method, "/api/v1/settings", body);
  }
  json settings() { return json::parse(ask("GET").body); }

  Ports ports;
  test::FixedGate gate{Role::kAdmin};
  SettingsApi api{ports, gate, facts("Borg")};
  RouteTable routes;
};

TEST_F(SettingsApiTest, TellsAndChangesThem) {
  EXPECT_EQ(settings(), (json{{"name", "Borg"}, {"trusted_range_m", 12.0}, {"trusted_range_most_m", 80.0}}));
  const HttpAnswer answer = ask("PATCH", R"({"name":"R\u00f6t \u0001"})");
  EXPECT_EQ(answer.status, 422);
  EXPECT_EQ(json::parse(ask("PATCH", R"({"name":"R\u00f6t"})").body)["name"], "R\xc3\xb6t");
  EXPECT_EQ(ask("PATCH", R"({"trusted_range_m":5.5})").status, 200);
  EXPECT_EQ(ports.trusted_range_m, 5.5);
  EXPECT_EQ(ask("PATCH", "{}").status, 200);
  EXPECT_EQ(settings()["name"], "R\xc3\xb6t");
}

TEST_F(SettingsApiTest, TakesNothingOfWhatIsPartlyWrong) {
  const std::string long_name(41, 'x');
  for (const std::string& body :
       {std::string(R"({"name":""})"), R"({"name":")" + long_name + R"("})", std::string(R"({"name":null})"),
        std::string(R"({"name":7})"), std::string(R"({"trusted_range_m":0.15})"),
        std::string(R"({"trusted_range_m":80.1})"), std::string(R"({"trusted_range_m":-1})"),
        std::string(R"({"trusted_range_m":"5"})"), std::string(R"({"name":"new","trusted_range_m":0})"),
        std::string(R"({"trusted_range_m":5,"name":""})"), std::string(R"({"name":"new","more":1})"),
        std::string(R"({"trusted_range_most_m":90})")})
    EXPECT_EQ(ask("PATCH", body).status, 422) << body;
  EXPECT_EQ(ask("PATCH", "[]").status, 400);
  EXPECT_EQ(ask("PATCH").status, 415);
  EXPECT_EQ(settings(), (json{{"name", "Borg"}, {"trusted_range_m", 12.0}, {"trusted_range_most_m", 80.0}}));
}

TEST_F(SettingsApiTest, ViewersLookAndAdminsChange) {
  for (const Role right : {Role::kNone, Role::kViewer, Role::kDriver, Role::kAdmin}) {
    gate.right = right;
    EXPECT_EQ(ask("GET").status == 403, right < Role::kViewer);
    EXPECT_EQ(ask("PATCH", "{}").status == 403, right < Role::kAdmin);
  }
}

TEST(SettingsApi, ARobotOnAMachineWithoutANameHasOne) {
  Ports ports;
  test::FixedGate gate{Role::kAdmin};
  for (const char* name : {"", "bad\nname"}) {
    SettingsApi api(ports, gate, facts(name));
    RouteTable routes;
    api.add_to(routes);
    EXPECT_EQ(json::parse(test::ask(routes, "GET", "/api/v1/settings").body)["name"], "dynslam");
  }
}

}  // namespace
}  // namespace dynslam
