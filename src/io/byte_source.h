// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace dynslam {

/// Bytes of a known length, read from front to back. One thread at a time.
class ByteSource {
 public:
  virtual ~ByteSource() = default;

  /// Reads up to `size` bytes; fewer only where the bytes end or the medium fails (then fault() says so).
  virtual std::size_t read(void* to, std::size_t size) = 0;

  /// Goes to a place `offset` bytes from the front, at most to the end. A fault is forgotten: there it may
  /// read well.
  virtual void seek(std::uint64_t offset) = 0;

  virtual std::uint64_t position() const = 0;
  virtual std::uint64_t size() const = 0;

  /// Why the medium failed; empty as long as it has not since the last seek().
  virtual std::string fault() const { return {}; }

  /// What a person knows it by, say the path; begins every message about it.
  virtual const std::string& name() const = 0;

  std::uint64_t remaining() const { return position() < size() ? size() - position() : 0; }
};

/// A regular file.
class FileSource final : public ByteSource {
 public:
  /// Throws InputError when the file is missing, no regular file, or may not be read.
  explicit FileSource(std::string path);

  std::size_t read(void* to, std::size_t size) override;
  void seek(std::uint64_t offset) override;
  std::uint64_t position() const override { return position_; }
  std::uint64_t size() const override { return size_; }
  std::string fault() const override { return fault_; }
  const std::string& name() const override { return path_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
  std::uint64_t size_ = 0;
  std::uint64_t position_ = 0;
  std::string fault_;
};

/// Bytes in memory, held by itself.
class MemorySource final : public ByteSource {
 public:
  explicit MemorySource(std::string bytes, std::string name = "memory")
      : bytes_(std::move(bytes)), name_(std::move(name)) {}

  std::size_t read(void* to, std::size_t size) override;
  void seek(std::uint64_t offset) override;
  std::uint64_t position() const override { return position_; }
  std::uint64_t size() const override { return bytes_.size(); }
  const std::string& name() const override { return name_; }

 private:
  std::string bytes_;
  std::string name_;
  std::size_t position_ = 0;
};

}  // namespace dynslam
