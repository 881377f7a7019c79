// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/config_field.h"

namespace dynslam {

/// One thing that can be set, and where its value is kept: a config without its types, so that reading and
/// printing are plain functions over a list. Valid as long as the struct that it points into.
struct ConfigKey {
  std::string_view section;  ///< the TOML table
  Field field;
  std::variant<bool*, int*, double*, std::string*, std::vector<std::string>*> value;

  /// "slam.cell_size_m"
  std::string name() const { return std::string(section) + '.' + std::string(field.name); }
};

/// Out of line: GCC 14 warns of an overflow where it inlines dozens of these in a row.
void append(const ConfigKey& key, std::vector<ConfigKey>& keys);

/// All keys of a config struct, in the order of its `sections` and their `fields`.
template <class AnyConfig>
std::vector<ConfigKey> keys_of(AnyConfig& config) {
  std::vector<ConfigKey> keys;
  AnyConfig::sections(config, [&](std::string_view section, auto& part) {
    std::remove_reference_t<decltype(part)>::fields(part, [&](const Field& field, auto& value) {
      append({section, field, &value}, keys);
    });
  });
  return keys;
}

/// A key that older versions knew.
struct OldKey {
  std::string_view name;  ///< "section.key"
  std::string_view now;   ///< what it is called now, of the same meaning; empty: it is not needed any more
  std::string_view why;   ///< it is not, the rest of a sentence
};

/// What is to be said of a file.
struct TomlFindings {
  std::vector<std::string> problems;  ///< what is wrong with it, by line
  std::vector<std::string> warnings;  ///< what has changed since it was written
};

/// Sets what a TOML text says; a key with a problem keeps its value. `place` is the name of the file for the
/// messages. A value under a key's old name counts unless there is one under the new.
TomlFindings read_toml(std::string_view text, const std::string& place, const std::vector<ConfigKey>& keys,
                       const std::vector<OldKey>& old_keys = {});

/// Sets one "section.key=value"; a string may go without its quotes. Returns what is wrong with it, or
/// nothing.
std::vector<std::string> read_setting(std::string_view setting, const std::vector<ConfigKey>& keys);

/// All keys with their values as TOML, with what each means and its limits as comments.
std::string to_toml(const std::vector<ConfigKey>& keys);

/// All keys with their values as {"section": {"key": value}}.
nlohmann::json to_json(const std::vector<ConfigKey>& keys);

}  // namespace dynslam
