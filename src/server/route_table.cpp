// SPDX-License-Identifier: MIT
#include "server/route_table.h"

#include <optional>
#include <utility>

namespace dynslam {
namespace {

constexpr std::string_view kPlace = "{}";

/// What stands in the pattern's place, when the path is of the pattern.
std::optional<std::string> matched(const std::string& pattern, const std::string& path) {
  const std::size_t at = pattern.find(kPlace);
  if (at == std::string::npos) return pattern == path ? std::optional(std::string()) : std::nullopt;
  const std::string_view before = std::string_view(pattern).substr(0, at);
  const std::string_view after = std::string_view(pattern).substr(at + kPlace.size());
  if (path.size() <= before.size() + after.size() || !path.starts_with(before) || !path.ends_with(after))
    return std::nullopt;
  std::string name = path.substr(at, path.size() - before.size() - after.size());
  if (name.find('/') != std::string::npos) return std::nullopt;
  return name;
}

}  // namespace

void RouteTable::add(std::string method, std::string path, Handler handler) {
  routes_.push_back({std::move(method), std::move(path), std::move(handler)});
}

HttpAnswer RouteTable::answer(const HttpRequest& request) const {
  const std::string method = request.method == "HEAD" ? "GET" : request.method;
  std::string allowed;
  for (const Route& route : routes_) {
    const auto name = matched(route.path, request.path);
    if (!name) continue;
    if (route.method == method) return route.handler(request, *name);
    allowed += (allowed.empty() ? "" : ", ") + route.method;
  }
  if (allowed.empty()) return error_answer(404, "there is nothing here by this name");
  HttpAnswer answer = error_answer(405, "this is not done with " + request.method + ", but with " + allowed);
  answer.headers.emplace_back("Allow", allowed);
  return answer;
}

}  // namespace dynslam
