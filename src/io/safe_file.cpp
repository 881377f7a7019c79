// SPDX-License-Identifier: MIT
#include "io/safe_file.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace dynslam {
namespace {

std::string cannot_write(const std::string& path, int error) {
  return "cannot write to " + path + ": " + std::generic_category().message(error);
}

std::string temporary_name(const std::string& name) { return "." + name + ".partial"; }

/// Best effort: that a folder which was just made is still there when the power was lost.
void sync_parent(const std::string& path) {
  const std::string parent = (std::filesystem::path(path) / "..").string();
  const int folder = ::open(parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  ::fsync(folder);
  ::close(folder);
}

/// A file that is being written; errors are runtime_errors that name `shown_path`.
class FileInWork {
 public:
  FileInWork(int folder, const std::string& name, std::string shown_path, unsigned mode)
      : shown_path_(std::move(shown_path)) {
    ::unlinkat(folder, name.c_str(), 0);  // what a killed run may have left behind
    file_ = ::openat(folder, name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
    if (file_ < 0) fail();
  }
  ~FileInWork() {
    if (file_ >= 0) ::close(file_);
  }
  FileInWork(const FileInWork&) = delete;
  FileInWork& operator=(const FileInWork&) = delete;

  void write(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t n = ::write(file_, bytes.data(), bytes.size());
      if (n >= 0) {
        bytes.remove_prefix(static_cast<std::size_t>(n));
      } else if (errno != EINTR) {
        fail();
      }
    }
  }

  /// Some file systems only tell at fsync or close that the disk was full.
  void finish() {
    const bool synced = ::fsync(file_) == 0;
    const int error = errno;
    const bool closed = ::close(std::exchange(file_, -1)) == 0;
    if (!synced) errno = error;
    if (!synced || !closed) fail();
  }

 private:
  [[noreturn]] void fail() const { throw std::runtime_error(cannot_write(shown_path_, errno)); }

  std::string shown_path_;
  int file_ = -1;
};

}  // namespace

OutputFolder::OutputFolder(std::string path, unsigned file_mode)
    : path_(std::move(path)), file_mode_(file_mode) {
  std::error_code error;
  const bool is_new = std::filesystem::create_directories(path_, error);
  if (error) throw InputError(cannot_write(path_, error.value()));
  if (is_new) sync_parent(path_);
  open_and_lock();
  try_writing();
}

OutputFolder::~OutputFolder() {
  for (const std::string& name : staged_) discard(name);
  ::close(folder_);
}

void OutputFolder::open_and_lock() {
  folder_ = ::open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder_ < 0) throw InputError(cannot_write(path_, errno));
  // A file system that knows no locks (some network ones) is used without.
  if (::flock(folder_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    ::close(folder_);
    throw FolderInUse("cannot write to " + path_ + ": another run is writing there");
  }
}

void OutputFolder::try_writing() {
  try {
    FileInWork(folder_, temporary_name("probe"), path_, file_mode_).write("?");
    discard("probe");
  } catch (const std::runtime_error& failure) {
    discard("probe");
    ::close(folder_);
    throw InputError(failure.what());
  }
}

void OutputFolder::discard(const std::string& name) noexcept {
  ::unlinkat(folder_, temporary_name(name).c_str(), 0);
}

std::string OutputFolder::shown(const std::string& name) const {
  return (std::filesystem::path(path_) / name).string();
}

/// Told early, because a rename that cannot work must not turn up halfway through commit().
void OutputFolder::refuse_folder(const std::string& name) const {
  struct stat there {};
  if (::fstatat(folder_, name.c_str(), &there, 0) == 0 && S_ISDIR(there.st_mode))
    throw std::runtime_error(cannot_write(shown(name), EISDIR));
}

std::string OutputFolder::reserve(const std::string& name) {
  refuse_folder(name);
  discard(name);  // what a killed run may have left behind
  std::erase(staged_, name);
  staged_.push_back(name);
  reserved_.push_back(name);
  return shown(temporary_name(name));
}

void OutputFolder::stage(const std::string& name, std::string_view bytes) {
  stage(name, [bytes](const ByteSink& sink) { sink(bytes); });
}

void OutputFolder::stage(const std::string& name, const std::function<void(const ByteSink&)>& write) {
  refuse_folder(name);
  std::erase(staged_, name);
  try {
    FileInWork file(folder_, temporary_name(name), shown(name), file_mode_);
    write([&file](std::string_view bytes) { file.write(bytes); });
    file.finish();
    staged_.push_back(name);
  } catch (...) {
    discard(name);
    throw;
  }
}

void OutputFolder::commit() {
  while (!staged_.empty()) {
    const std::string& name = staged_.front();
    const bool renamed = ::renameat(folder_, temporary_name(name).c_str(), folder_, name.c_str()) == 0;
    const bool never_written = errno == ENOENT && std::count(reserved_.begin(), reserved_.end(), name) > 0;
    if (!renamed && !never_written) throw std::runtime_error(cannot_write(shown(name), errno));
    if (!renamed) ::unlinkat(folder_, name.c_str(), 0);
    staged_.erase(staged_.begin());
  }
  ::fsync(folder_);  // best effort: the files are whole in any case
}

}  // namespace dynslam
