// SPDX-License-Identifier: MIT
#include "server/notes_api.h"

#include <nlohmann/json.hpp>

#include "server/body_fields.h"

namespace dynslam {
namespace {

HttpAnswer done_unless(const NoteBook::Refused& refused) {
  if (refused) return error_answer(refused->status, refused->why);
  HttpAnswer answer;
  answer.status = 204;
  return answer;
}

/// Two people may draw at the same time, and neither means to replace what the other drew.
NoteBook::Namesake namesake(const HttpRequest& request) {
  return request.header("if-none-match") == "*" ? NoteBook::Namesake::kKeep : NoteBook::Namesake::kReplace;
}

}  // namespace

void NotesApi::add_to(RouteTable& routes) {
  const std::string notes = "/api/v1/notes", place = notes + "/places/{}", area = notes + "/areas/{}",
                    home = notes + "/home";
  add(routes, "GET", notes.c_str(), Role::kViewer, &NotesApi::all);
  add(routes, "PUT", place.c_str(), Role::kDriver, &NotesApi::put_place);
  add(routes, "PATCH", place.c_str(), Role::kDriver, &NotesApi::rename_place);
  add(routes, "DELETE", place.c_str(), Role::kDriver, &NotesApi::remove_place);
  add(routes, "PUT", area.c_str(), Role::kDriver, &NotesApi::put_area);
  add(routes, "DELETE", area.c_str(), Role::kDriver, &NotesApi::remove_area);
  add(routes, "PUT", home.c_str(), Role::kDriver, &NotesApi::put_home);
  add(routes, "DELETE", home.c_str(), Role::kDriver, &NotesApi::remove_home);
  add(routes, "DELETE", "/api/v1/notes/notice", Role::kDriver, &NotesApi::dismiss_notice);
}

void NotesApi::add(RouteTable& routes, const char* method, const char* path, Role needed, Handler handler) {
  routes.add(method, path, [this, needed, handler](const HttpRequest& request, const std::string& name) {
    const Gate::Decision decision = gate_.admit(request, needed);
    return decision.refusal ? *decision.refusal : (this->*handler)(request, name);
  });
}

HttpAnswer NotesApi::all(const HttpRequest&, const std::string&) {
  HttpAnswer answer;
  answer.body = notes_json(book_.notes()).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  return answer;
}

HttpAnswer NotesApi::put_place(const HttpRequest& request, const std::string& name) {
  BodyFields body(request);
  Destination place = body.destination();
  if (const auto problem = body.problem()) return *problem;
  place.name = name;
  return done_unless(book_.put_place(place, namesake(request)));
}

HttpAnswer NotesApi::rename_place(const HttpRequest& request, const std::string& name) {
  BodyFields body(request);
  const std::string new_name = body.text("name");
  if (const auto problem = body.problem()) return *problem;
  return done_unless(book_.rename_place(name, new_name));
}

HttpAnswer NotesApi::remove_place(const HttpRequest&, const std::string& name) {
  return done_unless(book_.remove_place(name));
}

HttpAnswer NotesApi::put_area(const HttpRequest& request, const std::string& name) {
  BodyFields body(request);
  const NoGoArea area{name, body.points("corners")};
  if (const auto problem = body.problem()) return *problem;
  return done_unless(book_.put_area(area, namesake(request)));
}

HttpAnswer NotesApi::remove_area(const HttpRequest&, const std::string& name) {
  return done_unless(book_.remove_area(name));
}

HttpAnswer NotesApi::put_home(const HttpRequest& request, const std::string&) {
  BodyFields body(request);
  Destination home = body.destination();
  home.name = body.text_if("name").value_or("");
  if (const auto problem = body.problem()) return *problem;
  return done_unless(book_.put_home(home));
}

HttpAnswer NotesApi::remove_home(const HttpRequest&, const std::string&) {
  return done_unless(book_.remove_home());
}

HttpAnswer NotesApi::dismiss_notice(const HttpRequest&, const std::string&) {
  return done_unless(book_.dismiss_notice());
}

}  // namespace dynslam
