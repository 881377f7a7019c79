// SPDX-License-Identifier: MIT
#include "io/byte_source.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "base/error.h"

namespace dynslam {
namespace {

std::string error_text(int error) { return std::generic_category().message(error); }

/// Opening a pipe would wait for its writer, and a directory opens but does not read; hence the look
/// beforehand.
std::uint64_t size_of_regular_file(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) throw InputError(path + ": no such file");
  if (error) throw InputError(path + ": cannot be read: " + error.message());
  if (std::filesystem::is_directory(status)) throw InputError(path + ": is a directory");
  if (!std::filesystem::is_regular_file(status)) throw InputError(path + ": is not a regular file");
  const std::uint64_t size = std::filesystem::file_size(path, error);
  if (error) throw InputError(path + ": cannot be read: " + error.message());
  return size;
}

}  // namespace

FileSource::FileSource(std::string path) : path_(std::move(path)), size_(size_of_regular_file(path_)) {
  file_.reset(std::fopen(path_.c_str(), "rb"));
  if (!file_) throw InputError(path_ + ": cannot be read: " + error_text(errno));
}

std::size_t FileSource::read(void* to, std::size_t size) {
  const std::size_t got = std::fread(to, 1, size, file_.get());
  if (got < size && std::ferror(file_.get()) != 0) fault_ = error_text(errno);
  position_ += got;
  return got;
}

void FileSource::seek(std::uint64_t offset) {
  position_ = std::min(offset, size_);
  std::clearerr(file_.get());
  fault_.clear();
  if (fseeko(file_.get(), static_cast<off_t>(position_), SEEK_SET) != 0) fault_ = error_text(errno);
}

std::size_t MemorySource::read(void* to, std::size_t size) {
  const std::size_t got = std::min(size, bytes_.size() - position_);
  if (got > 0) std::memcpy(to, bytes_.data() + position_, got);
  position_ += got;
  return got;
}

void MemorySource::seek(std::uint64_t offset) {
  position_ = static_cast<std::size_t>(std::min<std::uint64_t>(offset, bytes_.size()));
}

}  // namespace dynslam
