// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

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
