// SPDX-License-Identifier: MIT
#include "io/recording_file.h"

#include <cerrno>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <aio.h>
#include <fcntl.h>
#include <sys/statvfs.h>
#include <unistd.h>

namespace dynslam {

RecordingFile::RecordingFile(std::string path, std::uint64_t free_floor)
    : path_(std::move(path)), free_floor_(free_floor) {
  const std::filesystem::path folder = std::filesystem::path(path_).parent_path();
  std::error_code error;
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  if (error) fail(error.value());
  file_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (file_ < 0) fail(errno);
}

RecordingFile::~RecordingFile() {
  settle();
  ::close(file_);
}

void RecordingFile::append(std::string_view bytes) {
  keep_floor(bytes.size());
  std::string_view left = bytes;
  while (!left.empty()) {
    const ssize_t n = ::write(file_, left.data(), left.size());
    if (n >= 0) {
      left.remove_prefix(static_cast<std::size_t>(n));
    } else if (errno != EINTR) {
      const int error = errno;
      cut_back();
      fail(error);
    }
  }
  size_ += bytes.size();
}

void RecordingFile::keep_floor(std::uint64_t bytes) const {
  if (free_floor_ == 0) return;
  struct statvfs disk {};
  if (::fstatvfs(file_, &disk) != 0) return;  // a file system that does not say tells when it is full
  const std::uint64_t free = std::uint64_t{disk.f_bavail} * disk.f_frsize;
  if (free >= free_floor_ + bytes) return;
  throw std::runtime_error(path_ + ": " + std::to_string(free >> 20) + " MiB are free on the disk, and " +
                           std::to_string(free_floor_ >> 20) + " MiB are to stay free");
}

/// A piece that was written in part would be taken for damage.
void RecordingFile::cut_back() noexcept {
  const auto end = static_cast<off_t>(size_);
  if (::ftruncate(file_, end) == 0) ::lseek(file_, end, SEEK_SET);
}

bool RecordingFile::syncing() const { return sync_ && ::aio_error(sync_.get()) == EINPROGRESS; }

/// The C library has a thread of its own for it.
void RecordingFile::sync_soon() {
  if (syncing()) return;
  settle();
  check_sync();
  sync_ = std::make_unique<aiocb>();
  sync_->aio_fildes = file_;
  sync_->aio_sigevent.sigev_notify = SIGEV_NONE;
  if (::aio_fsync(O_DSYNC, sync_.get()) != 0) sync_.reset();
}

/// Waits until nothing is under way.
void RecordingFile::settle() {
  const aiocb* const list[] = {sync_.get()};
  while (syncing()) ::aio_suspend(list, 1, nullptr);
  if (!sync_) return;
  const int error = ::aio_error(sync_.get());
  if (::aio_return(sync_.get()) != 0 && sync_error_ == 0) sync_error_ = error;
  sync_.reset();
}

/// The system tells of a piece that the disk did not take once, and calls the next attempt a success.
void RecordingFile::check_sync() const {
  if (sync_error_ != 0) fail(sync_error_);
}

void RecordingFile::sync() {
  settle();
  check_sync();
  if (::fsync(file_) != 0) fail(errno);
}

void RecordingFile::remove() noexcept { ::unlink(path_.c_str()); }

void RecordingFile::fail(int error) const {
  throw std::runtime_error("cannot write to " + path_ + ": " + std::generic_category().message(error));
}

}  // namespace dynslam
