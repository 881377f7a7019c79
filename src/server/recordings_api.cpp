// SPDX-License-Identifier: MIT
#include "server/recordings_api.h"

#include <algorithm>
#include <filesystem>
#include <vector>

#include <nlohmann/json.hpp>

#include "server/state_json.h"

namespace dynslam {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kNone = "there is no recording of this name";

/// Names that the recorder gives. What else may lie in the folder is nobody's business.
bool is_recording(const std::string& name) {
  const auto fits = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' ||
           c == '_' || c == '.';
  };
  return name.ends_with(".mcap") && name.front() != '.' && std::all_of(name.begin(), name.end(), fits);
}

HttpAnswer done() {
  HttpAnswer answer;
  answer.status = 204;
  return answer;
}

}  // namespace

void RecordingsApi::add_to(RouteTable& routes) {
  add(routes, "GET", "/api/v1/recordings", Role::kViewer, &RecordingsApi::list);
  add(routes, "POST", "/api/v1/recordings", Role::kDriver, &RecordingsApi::start);
  add(routes, "DELETE", "/api/v1/recordings", Role::kDriver, &RecordingsApi::stop);
  add(routes, "GET", "/api/v1/recordings/{}", Role::kViewer, &RecordingsApi::download);
  add(routes, "DELETE", "/api/v1/recordings/{}", Role::kAdmin, &RecordingsApi::remove);
}

void RecordingsApi::add(RouteTable& routes, const char* method, const char* path, Role needed,
                        Handler handler) {
  routes.add(method, path, [this, needed, handler](const HttpRequest& request, const std::string& name) {
    const Gate::Decision decision = gate_.admit(request, needed);
    return decision.refusal ? *decision.refusal : (this->*handler)(name);
  });
}

/// Empty when there is no such recording.
std::string RecordingsApi::path_of(const std::string& name) const {
  if (!is_recording(name)) return {};
  const fs::path path = fs::path(folder_) / name;
  std::error_code failed;
  return fs::is_regular_file(fs::symlink_status(path, failed)) ? path.string() : std::string();
}

HttpAnswer RecordingsApi::list(const std::string&) {
  std::vector<std::pair<std::string, std::uintmax_t>> files;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder_, failed)) {
    const std::string name = entry.path().filename();
    std::error_code gone;
    if (!path_of(name).empty()) files.emplace_back(name, entry.file_size(gone));
  }
  std::sort(files.begin(), files.end());
  json all = json::array();
  for (const auto& [name, bytes] : files) all.push_back({{"name", name}, {"bytes", bytes}});
  HttpAnswer answer;
  answer.body = json{{"recordings", all}, {"recording", recording_json(ports_)}}.dump();
  return answer;
}

HttpAnswer RecordingsApi::start(const std::string&) {
  const auto state = ports_.recording.get().value;
  if (state && state->active && state->asked_for)
    return error_answer(409, "a recording is under way already");
  ports_.recording_wish.put({true, {}});
  return done();
}

HttpAnswer RecordingsApi::stop(const std::string&) {
  ports_.recording_wish.put({false, {}});
  return done();
}

HttpAnswer RecordingsApi::download(const std::string& name) {
  HttpAnswer answer;
  answer.file = path_of(name);
  if (answer.file.empty()) return error_answer(404, kNone);
  answer.type = "application/octet-stream";
  answer.headers.emplace_back("Content-Disposition", "attachment; filename=\"" + name + "\"");
  return answer;
}

HttpAnswer RecordingsApi::remove(const std::string& name) {
  const std::string path = path_of(name);
  if (path.empty()) return error_answer(404, kNone);
  const auto state = ports_.recording.get().value;
  if (state && state->active && fs::path(state->file).filename() == name)
    return error_answer(409, "it is being written; end it first");
  std::error_code failed;
  fs::remove(path, failed);
  return failed ? error_answer(500, "it cannot be deleted: " + failed.message()) : done();
}

}  // namespace dynslam
