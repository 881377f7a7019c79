// SPDX-License-Identifier: MIT
#include "io/text_stream.h"

#include <algorithm>
#include <cstring>
#include <new>

#include <zlib.h>

namespace dynslam {
namespace {

constexpr std::size_t kBlock = 64 << 10;
constexpr int kGzipOnly = 16 + MAX_WBITS;
constexpr unsigned char kGzipMagic[] = {0x1F, 0x8B};

}  // namespace

void TextStream::EndInflate::operator()(z_stream_s* stream) const {
  inflateEnd(stream);
  delete stream;
}

TextStream::TextStream(ByteSource& source) : source_(source), packed_(kBlock) {
  refill();
  if (packed_end_ < 2 || !std::equal(kGzipMagic, kGzipMagic + 2, packed_.begin())) return;
  auto stream = std::make_unique<z_stream_s>();
  if (inflateInit2(stream.get(), kGzipOnly) != Z_OK) throw std::bad_alloc();
  inflate_.reset(stream.release());
  in_member_ = true;
}

TextStream::~TextStream() = default;

std::size_t TextStream::read(char* to, std::size_t size) {
  if (ended_ || size == 0) return 0;
  const std::size_t got = inflate_ ? read_gzip(to, size) : read_plain(to, size);
  if (got == 0) ended_ = true;
  if (got == 0 && !source_.fault().empty()) fail(source_.fault());
  return got;
}

bool TextStream::refill() {
  if (packed_begin_ < packed_end_) return true;
  packed_begin_ = 0;
  packed_end_ = source_.read(packed_.data(), packed_.size());
  return packed_end_ > 0;
}

std::size_t TextStream::read_plain(char* to, std::size_t size) {
  if (!refill()) return 0;
  const std::size_t got = std::min(size, packed_end_ - packed_begin_);
  std::memcpy(to, packed_.data() + packed_begin_, got);
  packed_begin_ += got;
  return got;
}

std::size_t TextStream::read_gzip(char* to, std::size_t size) {
  const std::size_t want = std::min<std::size_t>(size, kBlock);
  inflate_->next_out = reinterpret_cast<Bytef*>(to);
  inflate_->avail_out = static_cast<uInt>(want);
  while (inflate_->avail_out == want) {
    if (!in_member_ && !begin_next_member()) return 0;
    if (!refill()) {
      fail("the gzip data is cut off");
      return 0;
    }
    inflate_->next_in = packed_.data() + packed_begin_;
    inflate_->avail_in = static_cast<uInt>(packed_end_ - packed_begin_);
    const int result = inflate(inflate_.get(), Z_NO_FLUSH);
    packed_begin_ = packed_end_ - inflate_->avail_in;
    if (result == Z_STREAM_END) in_member_ = false;
    if (result != Z_STREAM_END && result != Z_OK && result != Z_BUF_ERROR) {
      fail("the gzip data is damaged");
      ended_ = true;
      break;  // what came out before is still good
    }
  }
  return want - inflate_->avail_out;
}

/// Whether another member follows. Zeros are padding, as tapes and some tools leave behind.
bool TextStream::begin_next_member() {
  while (refill() && packed_[packed_begin_] == 0) ++packed_begin_;
  if (!refill()) return false;
  if (packed_[packed_begin_] != kGzipMagic[0]) {
    fail("something other than gzip data follows");
    return false;
  }
  inflateReset(inflate_.get());
  in_member_ = true;
  return true;
}

void TextStream::fail(const std::string& why) {
  if (!fault_.empty()) return;
  const std::uint64_t offset = source_.position() - (packed_end_ - packed_begin_);
  fault_ = why + " at byte " + std::to_string(offset);
}

}  // namespace dynslam
