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

std::optional<HttpAnswer> BodyFields::problem() {
  if (!problem_ && taken_ != body_.size()) fail(422, "the request has fields that are not known");
  return problem_;
}

}  // namespace dynslam
