// SPDX-License-Identifier: MIT
#include "server/access/state_file.h"

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "base/error.h"

namespace dynslam {
namespace {

constexpr unsigned kOwnerOnly = 0600;

}  // namespace

StateFile::StateFile(const std::string& folder, std::string name)
    : folder_(folder, kOwnerOnly),
      name_(std::move(name)),
      path_((std::filesystem::path(folder) / name_).string()) {}

std::optional<std::string> StateFile::read() const {
  std::error_code error;
  const auto status = std::filesystem::status(path_, error);
  if (status.type() == std::filesystem::file_type::not_found) return std::nullopt;
  const auto fail = [&](const std::string& why) { throw InputError("cannot read " + path_ + ": " + why); };
  if (status.type() != std::filesystem::file_type::regular)
    fail(error ? error.message() : "it is no regular file");
  errno = 0;
  std::ifstream file(path_, std::ios::binary);
  if (!file) fail(std::generic_category().message(errno));
  std::string text(kLongest + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (file.bad()) fail(std::generic_category().message(errno));
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.size() > kLongest) fail("it is larger than 1 MiB");
  return text;
}

void StateFile::write(std::string_view text) {
  folder_.stage(name_, text);
  folder_.commit();
}

}  // namespace dynslam
