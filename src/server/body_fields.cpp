// SPDX-License-Identifier: MIT
#include "server/body_fields.h"

#include <cmath>

namespace dynslam {

BodyFields::BodyFields(const HttpRequest& request) {
  const std::string type = request.header("content-type");
  if (!type.starts_with("application/json")) fail(415, "the request must be application/json");
  body_ = nlohmann::json::parse(request.body, nullptr, false);
  if (!body_.is_object()) fail(400, "the request must be a JSON object");
}

void BodyFields::fail(int status, const std::string& sentence) {
  if (!problem_) problem_ = error_answer(status, sentence);
}

const nlohmann::json* BodyFields::take(const std::string& name) {
  if (!body_.is_object() || !body_.contains(name)) return nullptr;
  ++taken_;
  return &body_[name];
}

std::string BodyFields::text(const std::string& name) {
  if (body_.is_object() && body_.contains(name)) return text_if(name).value_or("");
  fail(422, name + " must be a text");
  return {};
}

std::optional<std::string> BodyFields::text_if(const std::string& name) {
  const nlohmann::json* value = take(name);
  if (value == nullptr) return std::nullopt;
  if (value->is_string()) return value->get<std::string>();
  fail(422, name + " must be a text");
  return std::nullopt;
}

double BodyFields::number(const std::string& name) {
  if (body_.is_object() && body_.contains(name)) return number_if(name).value_or(0.0);
  fail(422, name + " must be a number");
  return 0.0;
}

std::optional<double> BodyFields::number_if(const std::string& name) {
  const nlohmann::json* value = take(name);
  if (value == nullptr) return std::nullopt;
  if (value->is_number() && std::isfinite(value->get<double>())) return value->get<double>();
  fail(422, name + " must be a number");
  return std::nullopt;
}

std::vector<std::string> BodyFields::texts_if(const std::string& name) {
  const nlohmann::json* value = take(name);
  std::vector<std::string> texts;
  if (value == nullptr) return texts;
  if (!value->is_array()) fail(422, name + " must be a list of texts");
  for (const nlohmann::json& one : *value) {
    if (one.is_string()) texts.push_back(one.get<std::string>());
    if (!one.is_string()) fail(422, name + " must be a list of texts");
  }
  return texts;
}

std::vector<Vector2> BodyFields::points(const std::string& name) {
  const auto is_number = [](const nlohmann::json& n) {
    return n.is_number() && std::isfinite(n.get<double>());
  };
  const nlohmann::json* value = take(name);
  std::vector<Vector2> points;
  if (value != nullptr && value->is_array()) {
    for (const nlohmann::json& p : *value)
      if (p.is_array() && p.size() == 2 && is_number(p[0]) && is_number(p[1]))
        points.emplace_back(p[0].get<double>(), p[1].get<double>());
  }
  if (value == nullptr || !value->is_array() || points.size() != value->size())
    fail(422, name + " must be a list of points, [x, y] each");
  return points;
}

Destination BodyFields::destination() {
  Destination d;
  d.point_map = {number("x_m"), number("y_m")};
  if (const auto yaw = number_if("yaw_rad")) d.yaw_rad = wrap_angle(*yaw);
  return d;
}

std::optional<HttpAnswer> BodyFields::problem() {
  if (!problem_ && taken_ != body_.size()) fail(422, "the request has fields that are not known");
  return problem_;
}

}  // namespace dynslam
