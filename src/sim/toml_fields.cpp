// SPDX-License-Identifier: MIT
#include "sim/toml_fields.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/error.h"
#include "base/nearest_name.h"
#include "base/number_text.h"

namespace dynslam {
namespace {

constexpr Limits kCoordinate{-500.0, 500.0};

int line_of(const toml::node& node) { return static_cast<int>(node.source().begin.line); }

std::optional<double> number_of(const toml::node& node) {
  if (const auto* whole = node.as_integer()) return static_cast<double>(whole->get());
  if (const auto* real = node.as_floating_point()) return real->get();
  return std::nullopt;
}

bool is_within(double value, const Limits& limits) {  // false for NaN
  return value >= limits.min && value <= limits.max;
}

std::string limits_text(const Limits& limits) {
  return "a number from " + shortest_text(limits.min) + " to " + shortest_text(limits.max);
}

}  // namespace

void Problems::raise() const {
  auto sorted = found_;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::string text;
  for (const auto& [line, what] : sorted) {
    text += (text.empty() ? "" : "\n") + place_ + ':' + std::to_string(line) + ": " + what;
  }
  throw InputError(text);
}

TomlFields::TomlFields(const toml::table& table, std::string what, Problems& problems)
    : table_(table), what_(std::move(what)), problems_(problems), line_(std::max(1, line_of(table))) {}

const toml::node* TomlFields::find(std::string_view key) {
  asked_.emplace_back(key);
  return table_.get(key);
}

void TomlFields::complain(const toml::node& node, std::string_view key, const std::string& what) {
  has_gaps_ = true;
  problems_.add(std::max(line_, line_of(node)), what_ + ": " + std::string(key) + " must be " + what);
}

std::optional<double> TomlFields::number(std::string_view key, const Limits& limits) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const auto value = number_of(*node);
  if (value && is_within(*value, limits)) return value;
  complain(*node, key, limits_text(limits) + (value ? ", not " + shortest_text(*value) : ""));
  return std::nullopt;
}

bool TomlFields::flag(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return false;
  if (const auto* value = node->as_boolean()) return value->get();
  complain(*node, key, "true or false");
  return false;
}

std::optional<std::string> TomlFields::text(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  if (const auto* value = node->as_string()) return value->get();
  complain(*node, key, "a text in quotes");
  return std::nullopt;
}

std::optional<std::size_t> TomlFields::word(std::string_view key, const std::vector<std::string>& words) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const auto* value = node->as_string();
  if (value != nullptr) {
    const auto found = std::find(words.begin(), words.end(), value->get());
    if (found != words.end()) return found - words.begin();
  }
  std::string all;
  for (const std::string& one : words) all += (all.empty() ? "\"" : ", \"") + one + '"';
  complain(*node, key, "one of " + all);
  return std::nullopt;
}

std::optional<std::uint32_t> TomlFields::colour(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const auto* value = node->as_string();
  const std::string digits = value != nullptr ? value->get() : "";
  const bool is_colour = digits.size() == 7 && digits[0] == '#' &&
                         digits.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
  if (is_colour) return static_cast<std::uint32_t>(std::stoul(digits.substr(1), nullptr, 16));
  complain(*node, key, "a colour such as \"#c0a080\"");
  return std::nullopt;
}

std::optional<std::vector<double>> TomlFields::numbers(const toml::node& node, std::size_t count) {
  const toml::array* array = node.as_array();
  if (array == nullptr || array->size() != count) return std::nullopt;
  std::vector<double> values;
  for (const toml::node& element : *array) {
    const auto value = number_of(element);
    if (!value || !std::isfinite(*value)) return std::nullopt;
    values.push_back(*value);
  }
  return values;
}

std::optional<Vector2> TomlFields::point(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const auto values = numbers(*node, 2);
  if (values && is_within((*values)[0], kCoordinate) && is_within((*values)[1], kCoordinate)) {
    return Vector2((*values)[0], (*values)[1]);
  }
  complain(*node, key, "[x, y], each " + limits_text(kCoordinate));
  return std::nullopt;
}

std::optional<Vector2> TomlFields::size(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const auto values = numbers(*node, 2);
  if (values && is_within((*values)[0], kLength) && is_within((*values)[1], kLength)) {
    return Vector2((*values)[0], (*values)[1]);
  }
  complain(*node, key, "[length, width], each " + limits_text(kLength));
  return std::nullopt;
}

std::vector<std::vector<double>> TomlFields::rows(std::string_view key, std::size_t columns) {
  const toml::node* node = find(key);
  if (node == nullptr) return {};
  std::vector<std::vector<double>> all;
  const toml::array* array = node->as_array();
  if (array == nullptr) complain(*node, key, "an array of arrays of " + std::to_string(columns) + " numbers");
  if (array == nullptr) return {};
  for (const toml::node& element : *array) {
    if (auto row = numbers(element, columns)) {
      all.push_back(std::move(*row));
    } else {
      complain(element, key, "made of arrays of " + std::to_string(columns) + " finite numbers");
    }
  }
  return all;
}

std::vector<Vector2> TomlFields::points(std::string_view key, std::size_t at_least) {
  std::vector<Vector2> all;
  const toml::node* node = table_.get(key);
  for (const auto& row : rows(key, 2)) {
    if (is_within(row[0], kCoordinate) && is_within(row[1], kCoordinate)) {
      all.emplace_back(row[0], row[1]);
    } else {
      complain(*node, key, "made of points, each number from -500 to 500");
    }
  }
  if (node == nullptr && at_least > 0) fail(std::string(key) + " is missing");
  if (node != nullptr && node->is_array() && node->as_array()->size() < at_least) {
    complain(*node, key, "at least " + std::to_string(at_least) + " points");
  }
  return all;
}

const toml::table* TomlFields::table(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return nullptr;
  if (!node->is_table()) complain(*node, key, "a table");
  return node->as_table();
}

std::vector<const toml::table*> TomlFields::tables(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return {};
  std::vector<const toml::table*> all;
  const toml::array* array = node->as_array();
  if (array == nullptr) complain(*node, key, "an array of tables, as [[" + std::string(key) + "]]");
  if (array == nullptr) return {};
  for (const toml::node& element : *array) {
    if (const toml::table* one = element.as_table()) {
      all.push_back(one);
    } else {
      complain(element, key, "made of tables");
    }
  }
  return all;
}

void TomlFields::finish() {
  for (const auto& [key, node] : table_) {
    const std::string name(key.str());
    if (std::find(asked_.begin(), asked_.end(), name) != asked_.end()) continue;
    problems_.add(
        static_cast<int>(key.source().begin.line),
        what_ + ": unknown key " + name + "; the nearest known key is " + nearest_name(name, asked_));
  }
}

}  // namespace dynslam
