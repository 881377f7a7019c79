// SPDX-License-Identifier: MIT
#pragma once

#include "server/gate.h"
#include "server/note_book.h"
#include "server/route_table.h"

namespace dynslam {

/// The requests of web/openapi.yaml about what people draw on the map. Any thread.
class NotesApi {
 public:
  /// Both must outlive this.
  NotesApi(NoteBook& book, Gate& gate) : book_(book), gate_(gate) {}

  void add_to(RouteTable& routes);

 private:
  using Handler = HttpAnswer (NotesApi::*)(const HttpRequest&, const std::string& name);
  void add(RouteTable& routes, const char* method, const char* path, Role needed, Handler handler);

  HttpAnswer all(const HttpRequest&, const std::string&);
  HttpAnswer put_place(const HttpRequest&, const std::string& name);
  HttpAnswer rename_place(const HttpRequest&, const std::string& name);
  HttpAnswer remove_place(const HttpRequest&, const std::string& name);
  HttpAnswer put_area(const HttpRequest&, const std::string& name);
  HttpAnswer remove_area(const HttpRequest&, const std::string& name);
  HttpAnswer put_home(const HttpRequest&, const std::string&);
  HttpAnswer remove_home(const HttpRequest&, const std::string&);
  HttpAnswer dismiss_notice(const HttpRequest&, const std::string&);

  NoteBook& book_;
  Gate& gate_;
};

}  // namespace dynslam
