// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <toml++/toml.h>

#include "base/pose2.h"

namespace dynslam {

/// What is wrong with a file, collected.
class Problems {
 public:
  explicit Problems(std::string place) : place_(std::move(place)) {}
  void add(int line, const std::string& what) { found_.emplace_back(line, what); }
  bool empty() const { return found_.empty(); }
  /// Throws InputError with all of them, one a line, in the order of the lines. REQUIRES: !empty().
  [[noreturn]] void raise() const;

 private:
  std::string place_;
  std::vector<std::pair<int, std::string>> found_;
};

/// Limits of a number, inclusive.
struct Limits {
  double min, max;
};
inline constexpr Limits kLength{0.001, 1000.0};  ///< metres, of what must have a size
inline constexpr Limits kSeconds{0.0, 1e6};

/// Reads the keys of one table. What is missing, of a wrong type or beyond its limits becomes a problem that
/// names key and line, and reads as its default; finish() complains of keys that nobody asked for.
class TomlFields {
 public:
  TomlFields(const toml::table& table, std::string what, Problems& problems);

  int line() const { return line_; }
  void fail(const std::string& what) {
    has_gaps_ = true;
    problems_.add(line_, what_ + ": " + what);
  }
  /// Whether something could not be read, so that it holds defaults that nobody meant.
  bool has_gaps() const { return has_gaps_; }

  std::optional<double> number(std::string_view key, const Limits& limits);
  double number(std::string_view key, double fallback, const Limits& limits) {
    return number(key, limits).value_or(fallback);
  }
  bool flag(std::string_view key);
  std::optional<std::string> text(std::string_view key);
  /// One of some words, as its place among them.
  std::optional<std::size_t> word(std::string_view key, const std::vector<std::string>& words);
  std::optional<std::uint32_t> colour(std::string_view key);  ///< "#rrggbb"
  std::optional<Vector2> point(std::string_view key);
  /// Both numbers of at least a millimetre.
  std::optional<Vector2> size(std::string_view key);
  std::vector<Vector2> points(std::string_view key, std::size_t at_least);
  /// An array of arrays of `columns` numbers each.
  std::vector<std::vector<double>> rows(std::string_view key, std::size_t columns);
  const toml::table* table(std::string_view key);
  /// The tables of `[[key]]`, or of an array of tables.
  std::vector<const toml::table*> tables(std::string_view key);

  /// REQUIRES of the file: the key is there.
  template <class T>
  T needed(std::string_view key, std::optional<T> value, T fallback) {
    if (!value && lacks(key)) fail(std::string(key) + " is missing");
    return value.value_or(fallback);
  }
  void finish();

 private:
  const toml::node* find(std::string_view key);
  /// Whether the file says nothing of the key, so that there is no problem with it yet.
  bool lacks(std::string_view key) const { return !table_.contains(key); }
  void complain(const toml::node& node, std::string_view key, const std::string& what);
  std::optional<std::vector<double>> numbers(const toml::node& node, std::size_t count);

  const toml::table& table_;
  std::string what_;
  Problems& problems_;
  int line_;
  bool has_gaps_ = false;
  std::vector<std::string> asked_;
};

}  // namespace dynslam
