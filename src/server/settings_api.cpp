// SPDX-License-Identifier: MIT
#include "server/settings_api.h"

#include <nlohmann/json.hpp>

#include "base/number_text.h"
#include "server/body_fields.h"
#include "server/robot_name.h"

namespace dynslam {

SettingsApi::SettingsApi(Ports& ports, Gate& gate, const ServerFacts& facts)
    : ports_(ports),
      gate_(gate),
      least_m_(facts.trusted_range_least_m),
      most_m_(facts.trusted_range_most_m),
      name_(is_robot_name(facts.name) ? facts.name : "dynslam") {}

void SettingsApi::add_to(RouteTable& routes) {
  constexpr const char* kPath = "/api/v1/settings";
  routes.add("GET", kPath, [this](const HttpRequest& request, const std::string&) {
    const Gate::Decision decision = gate_.admit(request, Role::kViewer);
    return decision.refusal ? *decision.refusal : settings();
  });
  routes.add("PATCH", kPath, [this](const HttpRequest& request, const std::string&) {
    const Gate::Decision decision = gate_.admit(request, Role::kAdmin);
    return decision.refusal ? *decision.refusal : change(request);
  });
}

HttpAnswer SettingsApi::settings() const {
  const std::lock_guard lock(mutex_);
  const nlohmann::json all = {
      {"name", name_}, {"trusted_range_m", ports_.trusted_range_m.load()}, {"trusted_range_most_m", most_m_}};
  HttpAnswer answer;
  answer.body = all.dump();
  return answer;
}

/// All that is asked for, or nothing.
HttpAnswer SettingsApi::change(const HttpRequest& request) {
  BodyFields body(request);
  const std::optional<std::string> name = body.text_if("name");
  const std::optional<double> range_m = body.number_if("trusted_range_m");
  if (const auto problem = body.problem()) return *problem;
  if (name && !is_robot_name(*name)) return error_answer(422, std::string("name ").append(kRobotNameRule));
  if (range_m && !(*range_m > least_m_ && *range_m <= most_m_))
    return error_answer(422, "trusted_range_m must be more than " + shortest_text(least_m_) +
                                 " and at most " + shortest_text(most_m_));
  if (range_m) ports_.trusted_range_m = *range_m;
  if (name) {
    const std::lock_guard lock(mutex_);
    name_ = *name;
  }
  return settings();
}

}  // namespace dynslam
