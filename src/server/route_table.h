// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "server/http_message.h"

namespace dynslam {

/// Which handler a request is for. Immutable once filled; any thread.
class RouteTable {
 public:
  /// `name`: what stood in the path in place of {}; empty where there is no such place.
  using Handler = std::function<HttpAnswer(const HttpRequest&, const std::string& name)>;

  /// A path has at most one place, {}, which stands for one step that is not empty.
  void add(std::string method, std::string path, Handler handler);

  /// What the handler answers; 404 and 405 where there is none. HEAD is answered as GET.
  HttpAnswer answer(const HttpRequest& request) const;

 private:
  struct Route {
    std::string method, path;
    Handler handler;
  };
  std::vector<Route> routes_;
};

}  // namespace dynslam
