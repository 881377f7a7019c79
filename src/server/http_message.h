// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace dynslam {

/// What a client asks for.
struct HttpRequest {
  std::string method, path;
  std::map<std::string, std::string> query;
  std::map<std::string, std::string> headers;  ///< names in lower case; of several the first
  std::string body;
  std::string address;  ///< of the client

  /// Empty when there is none.
  std::string header(const std::string& name) const {
    const auto found = headers.find(name);
    return found == headers.end() ? std::string() : found->second;
  }
};

struct HttpAnswer {
  int status = 200;
  std::string type = "application/json";
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers;  ///< besides those that every answer has
  std::string file;                                          ///< sent instead of the body
  std::shared_ptr<void> held;                                ///< let go once all is sent
};

/// The line that every error has for its body: {"error": "one sentence"}.
HttpAnswer error_answer(int status, const std::string& sentence);

}  // namespace dynslam
