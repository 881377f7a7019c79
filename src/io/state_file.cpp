// SPDX-License-Identifier: MIT
#include "io/state_file.h"

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "base/error.h"

namespace dynslam {
namespace {

namespace fs = std::filesystem;

constexpr unsigned kOwnerOnly = 0600;

}  // namespace

StateFile::StateFile(std::string folder, std::string name)
    : folder_path_(std::move(folder)),
      name_(std::move(name)),
      path_((fs::path(folder_path_) / name_).string()) {
  try {
    folder_.emplace(folder_path_, kOwnerOnly);
  } catch (const FolderInUse&) {
    throw;
  } catch (const InputError& error) {
    trouble_ = error.what();
  }
}

std::string StateFile::load(const std::function<void(const std::string&)>& take) {
  std::string why;
  try {
    if (const auto text = read()) take(*text);
    return {};
  } catch (const InputError& error) {
    why = path_ + " cannot be used: " + error.what();
  }
  const std::string away = free_name(name_ + ".damaged", "");
  if (set_aside(away)) return why + ". It is kept as " + away + '.';
  return why + ". It cannot be moved away either, so nothing is saved.";
}

std::optional<std::string> StateFile::read() const {
  std::error_code error;
  const auto status = fs::status(path_, error);
  if (status.type() == fs::file_type::not_found) return std::nullopt;
  if (status.type() != fs::file_type::regular)
    throw InputError(error ? error.message() : "it is no regular file");
  errno = 0;
  std::ifstream file(path_, std::ios::binary);
  if (!file) throw InputError(std::generic_category().message(errno));
  std::string text(kLongest + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (file.bad()) throw InputError(std::generic_category().message(errno));
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.size() > kLongest) throw InputError("it is larger than 1 MiB");
  return text;
}

bool StateFile::set_aside(const std::string& other_name) {
  away_ = other_name;
  try {
    move_away();
  } catch (const std::runtime_error& error) {
    trouble_ = error.what();
  }
  return away_.empty();
}

std::string StateFile::free_name(const std::string& stem, const std::string& end) const {
  std::string name = stem + end;
  std::error_code unknown;
  for (int n = 2; fs::exists(fs::symlink_status(fs::path(folder_path_) / name, unknown)); ++n)
    name.assign(stem).append("-").append(std::to_string(n)).append(end);
  return name;
}

void StateFile::move_away() {
  if (away_.empty()) return;
  std::error_code failed;
  fs::rename(path_, fs::path(folder_path_) / away_, failed);
  if (failed) throw std::runtime_error("cannot move " + path_ + " away: " + failed.message());
  away_.clear();
}

void StateFile::write(std::string_view text) {
  try {
    move_away();
    if (!folder_) folder_.emplace(folder_path_, kOwnerOnly);
    folder_->stage(name_, text);
    folder_->commit();
    trouble_.clear();
  } catch (const std::runtime_error& error) {
    trouble_ = error.what();
    folder_.reset();  // it may be another one next time
    throw;
  }
}

}  // namespace dynslam
