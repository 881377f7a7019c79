// SPDX-License-Identifier: MIT
#include "server/notes_api.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/fixed_gate.h"

namespace dynslam {
namespace {

using nlohmann::json;

class NotesApiTest : public testing::Test {
 protected:
  NotesApiTest() { api.add_to(routes); }
  HttpAnswer ask(const std::string& method, const std::string& path, const std::string& body = {}) {
    return test::ask(routes, method, "/api/v1/notes" + path, body);
  }
  int status(const std::string& method, const std::string& path, const std::string& body = {}) {
    return ask(method, path, body).status;
  }
  json notes() { return json::parse(ask("GET", "").body); }

  Latest<MapNotes> robot;
  NoteBook book{robot, "20261126-144501", std::nullopt};
  test::FixedGate gate{Role::kDriver};
  NotesApi api{book, gate};
  RouteTable routes;
};

TEST_F(NotesApiTest, KeepsWhatPeopleDraw) {
  EXPECT_EQ(notes(), (json{{"map_id", "20261126-144501"},
                           {"notice", ""},
                           {"home", nullptr},
                           {"places", json::array()},
                           {"areas", json::array()}}));
  EXPECT_EQ(status("PUT", "/places/The kitchen", R"({"x_m":1,"y_m":2,"yaw_rad":0.5})"), 204);
  EXPECT_EQ(status("PUT", "/areas/Stairs", R"({"corners":[[0,0],[1,0],[1.5,1]]})"), 204);
  EXPECT_EQ(status("PUT", "/home", R"({"x_m":-1,"y_m":0,"name":"Dock"})"), 204);
  EXPECT_EQ(status("PATCH", "/places/The kitchen", R"({"name":"Kitchen"})"), 204);
  const json all = notes();
  EXPECT_EQ(all["places"],
            (json::array({{{"name", "Kitchen"}, {"x_m", 1.0}, {"y_m", 2.0}, {"yaw_rad", 0.5}}})));
  EXPECT_EQ(all["areas"],
            (json::array({{{"name", "Stairs"}, {"corners", {{0.0, 0.0}, {1.0, 0.0}, {1.5, 1.0}}}}})));
  EXPECT_EQ(all["home"], (json{{"name", "Dock"}, {"x_m", -1.0}, {"y_m", 0.0}}));
  for (const char* path : {"/places/Kitchen", "/areas/Stairs", "/home", "/notice"})
    EXPECT_EQ(status("DELETE", path), 204) << path;
  EXPECT_TRUE(book.notes().is_empty());
  EXPECT_EQ(status("DELETE", "/places/Kitchen"), 404);
}

TEST_F(NotesApiTest, RefusesWhatIsNoDrawing) {
  EXPECT_EQ(status("PUT", "/places/p", R"({"x_m":1})"), 422);
  EXPECT_EQ(status("PUT", "/places/p", R"({"x_m":1,"y_m":1001})"), 422);
  EXPECT_EQ(status("PUT", "/places/p", R"({"x_m":1,"y_m":1,"name":"q"})"), 422) << "its name is in the path";
  EXPECT_EQ(status("PUT", "/places/p"), 415);
  EXPECT_EQ(status("PUT", "/places/", R"({"x_m":1,"y_m":1})"), 404);
  EXPECT_EQ(status("PUT", "/home", R"({"x_m":1,"y_m":1,"name":"a/b"})"), 422);
  for (const char* corners : {"[]", "[[0,0],[1,1]]", "[[0,0],[1,1],[2]]", "[[0,0],[1,1],[2,\"3\"]]", "{}",
                              "null", "[[0,0],[1,1],[1,1001]]"})
    EXPECT_EQ(status("PUT", "/areas/a", R"({"corners":)" + std::string(corners) + "}"), 422) << corners;
  EXPECT_TRUE(book.notes().is_empty());
}

TEST_F(NotesApiTest, WhatIsNewTakesNoPlaceOfWhatIsThere) {
  const char* corners[] = {R"({"corners":[[0,0],[1,0],[1,1]]})", R"({"corners":[[5,5],[6,5],[6,6]]})"};
  const auto put_new = [&](const std::string& path, const std::string& body) {
    return test::ask(routes, "PUT", "/api/v1/notes" + path, body, {{"if-none-match", "*"}}).status;
  };
  EXPECT_EQ(put_new("/areas/Stairs", corners[0]), 204);
  EXPECT_EQ(put_new("/areas/Stairs", corners[1]), 412);
  EXPECT_EQ(put_new("/places/Sofa", R"({"x_m":1,"y_m":2})"), 204);
  EXPECT_EQ(put_new("/places/Sofa", R"({"x_m":3,"y_m":4})"), 412);
  EXPECT_EQ(notes()["areas"][0]["corners"][0], (json{0.0, 0.0}));
  EXPECT_EQ(notes()["places"][0]["x_m"], 1.0);
  EXPECT_EQ(status("PUT", "/areas/Stairs", corners[1]), 204);
  EXPECT_EQ(notes()["areas"][0]["corners"][0], (json{5.0, 5.0}));
}

TEST_F(NotesApiTest, ViewersLookAndDriversDraw) {
  gate.right = Role::kViewer;
  EXPECT_EQ(status("GET", ""), 200);
  for (const auto& [method, path] : std::vector<std::pair<const char*, const char*>>{{"PUT", "/places/p"},
                                                                                     {"PATCH", "/places/p"},
                                                                                     {"DELETE", "/places/p"},
                                                                                     {"PUT", "/areas/a"},
                                                                                     {"DELETE", "/areas/a"},
                                                                                     {"PUT", "/home"},
                                                                                     {"DELETE", "/home"},
                                                                                     {"DELETE", "/notice"}})
    EXPECT_EQ(status(method, path), 403) << method << path;
  gate.right = Role::kNone;
  EXPECT_EQ(status("GET", ""), 403);
}

}  // namespace
}  // namespace dynslam
