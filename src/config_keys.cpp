// SPDX-License-Identifier: MIT
#include "config_keys.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include <nlohmann/json.hpp>
#include <toml++/toml.h>

#include "base/nearest_name.h"
#include "base/number_text.h"

namespace dynslam {
namespace {

using Keys = std::vector<ConfigKey>;

// A TOML basic string, always one line.
std::string toml_text(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) >= 0x20 && c != 0x7f) {
      out += c;
    } else {
      constexpr std::string_view kHex = "0123456789abcdef";
      out += "\\u00";
      out += kHex[static_cast<std::size_t>(c) >> 4];
      out += kHex[static_cast<std::size_t>(c) & 15];
    }
  }
  return out + '"';
}

std::string toml_text(bool value) { return value ? "true" : "false"; }
std::string toml_text(int value) { return std::to_string(value); }
std::string toml_text(double value) {
  const std::string text = shortest_text(value);
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;  // "12" would be an integer
}

std::string toml_text(const std::vector<std::string>& texts) {
  std::string out;
  for (const std::string& text : texts) out += (out.empty() ? "" : ", ") + toml_text(text);
  return '[' + out + ']';
}

/// What the file holds instead of what was wanted, short enough for a message.
std::string shown(const toml::node& node) {
  if (node.is_table()) return "a table";
  if (node.is_array()) return "an array";
  if (const auto* text = node.as_string()) return toml_text(text->get().substr(0, 40));
  if (const auto* number = node.as_floating_point()) return toml_text(number->get());
  std::ostringstream out;
  out << toml::node_view<const toml::node>(node);
  return out.str();
}

/// " from 2 to 10000", " of at least 2", " of at most 10000" or nothing.
std::string limits_text(const Field& field) {
  const bool has_min = std::isfinite(field.min), has_max = std::isfinite(field.max);
  if (has_min && has_max) return " from " + shortest_text(field.min) + " to " + shortest_text(field.max);
  if (has_min) return " of at least " + shortest_text(field.min);
  return has_max ? " of at most " + shortest_text(field.max) : "";
}

std::string wanted(const Field&, const bool*) { return "true or false"; }
std::string wanted(const Field& field, const int*) { return "a whole number" + limits_text(field); }
std::string wanted(const Field& field, const double*) { return "a number" + limits_text(field); }
std::string wanted(const Field&, const std::string*) { return "a text in quotes"; }
std::string wanted(const Field&, const std::vector<std::string>*) { return "a list of texts in quotes"; }
std::string wanted(const ConfigKey& key) {
  return std::visit([&](const auto* value) { return wanted(key.field, value); }, key.value);
}

// One overload for each type a field can have: false when the node is of another type or beyond the field's
// limits.

bool read_value(const toml::node& node, const Field&, bool& value) {
  if (!node.is_boolean()) return false;
  value = **node.as_boolean();
  return true;
}

bool read_value(const toml::node& node, const Field& field, double& value) {
  if (!node.is_number()) return false;
  const double read =
      node.is_integer() ? static_cast<double>(**node.as_integer()) : **node.as_floating_point();
  if (!std::isfinite(read) || read < field.min || read > field.max) return false;
  value = read;
  return true;
}

bool read_value(const toml::node& node, const Field& field, int& value) {
  double read = 0.0;  // exact for every int
  if (!node.is_integer() || !read_value(node, field, read)) return false;
  if (std::abs(read) > static_cast<double>(std::numeric_limits<int>::max())) return false;
  value = static_cast<int>(read);
  return true;
}

bool read_value(const toml::node& node, const Field&, std::string& value) {
  if (!node.is_string()) return false;
  value = **node.as_string();
  return true;
}

bool read_value(const toml::node& node, const Field& field, std::vector<std::string>& value) {
  const auto* array = node.as_array();
  if (array == nullptr) return false;
  std::vector<std::string> read(array->size());
  for (std::size_t i = 0; i < read.size(); ++i)
    if (!read_value(*array->get(i), field, read[i])) return false;
  value = std::move(read);
  return true;
}

bool read_value(const toml::node& node, const ConfigKey& key) {
  return std::visit([&](auto* value) { return read_value(node, key.field, *value); }, key.value);
}

std::string unknown_key(const std::string& name, const Keys& keys) {
  std::vector<std::string> names;
  for (const ConfigKey& key : keys) names.push_back(key.name());
  return "unknown key; the nearest known key is " + nearest_name(name, names);
}

std::string unknown_table(const std::string& name, const Keys& keys) {
  std::vector<std::string> names;
  for (const ConfigKey& key : keys) names.emplace_back(key.section);
  return "unknown table; the nearest known table is [" + nearest_name(name, names) + "]";
}

/// Reads a file into the keys and collects what is to be said of it.
class TomlReader {
 public:
  TomlReader(const std::string& place, const Keys& keys, const std::vector<OldKey>& old_keys)
      : place_(place), keys_(keys), old_keys_(old_keys) {}

  void read(const toml::table& file) {
    file_ = &file;
    for (const auto& [key, node] : file) {
      const std::string name(key.str());
      const bool is_section = knows_section(name);
      if (is_section && node.is_table()) {
        read_section(name, *node.as_table());
      } else if (is_section) {
        problem(key, name, "must be a table, not " + shown(node));
      } else {
        problem(key, name, node.is_table() ? unknown_table(name, keys_) : unknown_key(name, keys_));
      }
    }
  }

  TomlFindings findings() { return {in_order(problems_), in_order(warnings_)}; }

 private:
  using Said = std::vector<std::pair<toml::source_index, std::string>>;

  bool knows_section(const std::string& name) const {
    return std::any_of(keys_.begin(), keys_.end(), [&](const auto& k) { return k.section == name; }) ||
           std::any_of(old_keys_.begin(), old_keys_.end(),
                       [&](const auto& k) { return k.name.starts_with(name + '.'); });
  }

  void read_section(const std::string& section, const toml::table& table) {
    for (const auto& [key, node] : table) read_key(key, section + '.' + std::string(key.str()), node);
  }

  void read_key(const toml::key& key, const std::string& name, const toml::node& node) {
    const auto known =
        std::find_if(keys_.begin(), keys_.end(), [&](const ConfigKey& k) { return k.name() == name; });
    const auto old =
        std::find_if(old_keys_.begin(), old_keys_.end(), [&](const OldKey& k) { return k.name == name; });
    if (known != keys_.end()) {
      if (!read_value(node, *known)) problem(key, name, "must be " + wanted(*known) + ", not " + shown(node));
    } else if (old == old_keys_.end()) {
      problem(key, name, unknown_key(name, keys_));
    } else if (old->now.empty()) {
      warning(key, name, "is not read any more: " + std::string(old->why));
    } else if (file_->at_path(old->now)) {
      warning(key, name, "is not read, as " + std::string(old->now) + ", its newer name, is there as well");
    } else {
      warning(key, name, "is called " + std::string(old->now) + " now, and was read as that");
      read_key(key, std::string(old->now), node);
    }
  }

  void problem(const toml::key& key, const std::string& name, const std::string& what) {
    problems_.emplace_back(key.source().begin.line, place_of(key) + name + ": " + what);
  }
  void warning(const toml::key& key, const std::string& name, const std::string& what) {
    warnings_.emplace_back(key.source().begin.line, place_of(key) + name + ": " + what);
  }
  std::string place_of(const toml::key& key) const {
    return place_ + ':' + std::to_string(key.source().begin.line) + ": ";
  }

  /// Of the lines; toml++ lists keys by name.
  static std::vector<std::string> in_order(Said& said) {
    std::stable_sort(said.begin(), said.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<std::string> lines;
    for (auto& [line, text] : said) lines.push_back(std::move(text));
    return lines;
  }

  const std::string& place_;
  const Keys& keys_;
  const std::vector<OldKey>& old_keys_;
  const toml::table* file_ = nullptr;
  Said problems_, warnings_;
};

/// The text of a value to the key; false when it is not TOML, more than one value, or not what the key takes.
bool read_setting_value(const std::string& text, const ConfigKey& key) {
  auto* const* string = std::get_if<std::string*>(&key.value);
  if (string != nullptr && !text.starts_with('"') && !text.starts_with('\'')) {
    **string = text;
    return true;
  }
  try {
    const toml::table parsed = toml::parse("value = " + text);
    return parsed.size() == 1 && read_value(*parsed.get("value"), key);
  } catch (const toml::parse_error&) {
    return false;
  }
}

}  // namespace

void append(const ConfigKey& key, std::vector<ConfigKey>& keys) { keys.push_back(key); }

TomlFindings read_toml(std::string_view text, const std::string& place, const Keys& keys,
                       const std::vector<OldKey>& old_keys) {
  try {
    TomlReader reader(place, keys, old_keys);
    reader.read(toml::parse(text));
    return reader.findings();
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    return {{place + ':' + std::to_string(at.line) + ':' + std::to_string(at.column) + ": " +
             std::string(error.description())},
            {}};
  }
}

std::vector<std::string> read_setting(std::string_view setting, const Keys& keys) {
  const std::string place = "--set " + std::string(setting) + ": ";
  const std::size_t equals = setting.find('=');
  if (equals == std::string_view::npos) return {place + "must be section.key=value"};
  const std::string name(setting.substr(0, equals));
  const auto known =
      std::find_if(keys.begin(), keys.end(), [&](const ConfigKey& k) { return k.name() == name; });
  if (known == keys.end()) return {place + unknown_key(name, keys)};
  if (read_setting_value(std::string(setting.substr(equals + 1)), *known)) return {};
  return {place + "must be " + wanted(*known)};
}

std::string to_toml(const Keys& keys) {
  std::string text;
  std::string_view section;
  for (const ConfigKey& key : keys) {
    if (key.section != section) text += (text.empty() ? "[" : "\n[") + std::string(key.section) + "]\n";
    section = key.section;
    const std::string value = std::visit([](const auto* v) { return toml_text(*v); }, key.value);
    text += "# " + std::string(key.field.doc) + ": " + wanted(key) + '\n';
    text += std::string(key.field.name) + " = " + value + '\n';
  }
  return text;
}

nlohmann::json to_json(const Keys& keys) {
  nlohmann::json json = nlohmann::json::object();
  for (const ConfigKey& key : keys) {
    std::visit([&](const auto* v) { json[std::string(key.section)][std::string(key.field.name)] = *v; },
               key.value);
  }
  return json;
}

}  // namespace dynslam
