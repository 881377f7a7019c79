// SPDX-License-Identifier: MIT
#include "config.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <nlohmann/json.hpp>

#include "config_keys.h"

namespace dynslam {
namespace {

constexpr std::size_t kMaxFileBytes = 1 << 20;

std::string read_text(const std::string& path) {
  const auto fail = [&](const std::string& why) {
    throw InputError("cannot read config " + path + ": " + why);
  };
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) fail("is a directory");
  if (std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored) &&
      path != "/dev/null") {
    fail("is no regular file");
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) fail(std::strerror(errno));
  std::string text(kMaxFileBytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (file.bad()) fail(std::strerror(errno));
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.size() > kMaxFileBytes) fail("larger than 1 MiB");
  return text;
}

/// So that a file which was written for an older version still serves. Whoever renames a key, or takes one
/// away, adds it.
std::vector<OldKey> old_keys() {
  return {{"imu.calibration_file", "", "the calibration is kept in state.folder"}};
}

void append(std::vector<std::string>& all, std::vector<std::string> more) {
  for (std::string& one : more) all.push_back(std::move(one));
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + line;
  return text;
}

}  // namespace

ConfigError::ConfigError(std::vector<std::string> all_problems)
    : InputError(joined(all_problems)), problems(std::move(all_problems)) {}

Config make_config(const std::optional<std::string>& path, const std::vector<std::string>& settings) {
  Config config;
  const std::vector<ConfigKey> keys = keys_of(config);
  std::vector<std::string> problems;
  if (path) {
    TomlFindings findings = read_toml(read_text(*path), *path, keys, old_keys());
    append(problems, std::move(findings.problems));
    config.warnings = std::move(findings.warnings);
  }
  for (const std::string& setting : settings) append(problems, read_setting(setting, keys));
  if (problems.empty())
    for (const auto& problem :
         {config.slam.problem(), config.drive.clearance.problem(), config.drive.follower.problem(),
          config.server.problem(), config.access.problem(), config.autopilot.problem(),
          config.planner.problem(), config.hardware.imu.problem(), config.hardware.camera.problem(),
          config.hardware.gpio.problem(), config.hardware.encoders.problem(), config.hardware.problem()})
      if (problem) problems.push_back(*problem);
  if (!problems.empty()) throw ConfigError(std::move(problems));
  return config;
}

Config load_config(const std::string& path) { return make_config(path, {}); }

void apply_setting(Config& config, std::string_view setting) {
  std::vector<std::string> problems = read_setting(setting, keys_of(config));
  if (!problems.empty()) throw ConfigError(std::move(problems));
}

std::string config_reference(const Config& config) {
  Config copy = config;  // the keys could write to it
  return to_toml(keys_of(copy));
}

nlohmann::json config_json(const Config& config) {
  Config copy = config;
  return to_json(keys_of(copy));
}

}  // namespace dynslam
