// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "autopilot/order.h"
#include "server/http_message.h"

namespace dynslam {

/// A request's JSON object, taken apart field by field. The first thing that is wrong is kept as an answer.
class BodyFields {
 public:
  explicit BodyFields(const HttpRequest& request);

  std::string text(const std::string& name);
  std::optional<std::string> text_if(const std::string& name);
  double number(const std::string& name);
  std::optional<double> number_if(const std::string& name);
  /// Of all sizes; empty when there is no such field.
  std::vector<std::string> texts_if(const std::string& name);
  /// Points as [x, y].
  std::vector<Vector2> points(const std::string& name);
  /// The fields x_m and y_m, and yaw_rad if there is one.
  Destination destination();
  /// REQUIRES: all fields were asked for. What is wrong, also when there is more in the body than was asked
  /// for.
  std::optional<HttpAnswer> problem();

 private:
  void fail(int status, const std::string& sentence);
  const nlohmann::json* take(const std::string& name);

  nlohmann::json body_;
  std::size_t taken_ = 0;
  std::optional<HttpAnswer> problem_;
};

}  // namespace dynslam
