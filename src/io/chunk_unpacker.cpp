// SPDX-License-Identifier: MIT
#include "io/chunk_unpacker.h"

#include <algorithm>
#include <cstring>
#include <new>

#include <lz4frame.h>
#include <zstd.h>

namespace dynslam {
namespace {

constexpr std::size_t kBlock = 64 << 10;
constexpr int kMaxWindowLog = 27;  // 128 MiB: what a frame's header can make zstd ask for

LZ4F_dctx* new_lz4() {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0) throw std::bad_alloc();
  return context;
}

}  // namespace

void ChunkUnpacker::FreeZstd::operator()(ZSTD_DCtx_s* context) const { ZSTD_freeDCtx(context); }
void ChunkUnpacker::FreeLz4::operator()(LZ4F_dctx_s* context) const {
  LZ4F_freeDecompressionContext(context);
}

ChunkUnpacker::ChunkUnpacker() : zstd_(ZSTD_createDCtx()), lz4_(new_lz4()), in_(kBlock) {
  if (!zstd_) throw std::bad_alloc();
  ZSTD_DCtx_setParameter(zstd_.get(), ZSTD_d_windowLogMax, kMaxWindowLog);
}

ChunkUnpacker::~ChunkUnpacker() = default;

UnpackResult ChunkUnpacker::unpack(ByteSource& source, std::uint64_t packed_size,
                                   std::string_view compression, std::size_t size) {
  filled_ = 0;
  in_frame_ = false;
  Stepper stepper = nullptr;
  if (compression.empty()) stepper = &ChunkUnpacker::copy_step;
  if (compression == "zstd") stepper = &ChunkUnpacker::zstd_step;
  if (compression == "lz4") stepper = &ChunkUnpacker::lz4_step;
  if (stepper == nullptr) return UnpackResult::kUnsupported;
  ZSTD_DCtx_reset(zstd_.get(), ZSTD_reset_session_only);
  LZ4F_resetDecompressionContext(lz4_.get());

  std::uint64_t left = packed_size;
  while (left > 0) {
    const auto want = static_cast<std::size_t>(std::min<std::uint64_t>(left, in_.size()));
    const std::size_t got = source.read(in_.data(), want);
    if (!feed(stepper, {in_.data(), got}, size)) return UnpackResult::kDamaged;
    if (got < want) return UnpackResult::kCutOff;
    left -= got;
  }
  return filled_ == size && !in_frame_ ? UnpackResult::kWhole : UnpackResult::kDamaged;
}

/// Takes one block. False where it makes no sense or more comes out than `size`.
bool ChunkUnpacker::feed(Stepper stepper, Bytes in, std::size_t size) {
  bool is_room_full = false;
  while (!in.empty() || is_room_full) {
    const std::span<std::uint8_t> room = room_up_to(size);
    const Step step = (this->*stepper)(in, room);
    filled_ += step.out;
    in = in.subspan(step.in);
    in_frame_ = !step.frame_ended;
    if (step.failed || filled_ > size) return false;
    is_room_full = in_frame_ && step.out == room.size();  // more may wait inside the unpacker
    if (step.in == 0 && step.out == 0) return in.empty();
  }
  return true;
}

/// Free room behind what is filled: never empty, at most one byte over `size`, which then shows that there is
/// too much.
std::span<std::uint8_t> ChunkUnpacker::room_up_to(std::size_t size) {
  if (out_.size() < filled_ + kBlock) {
    out_.resize(std::max(out_.size(), std::min(size + 1, std::max(filled_ + kBlock, 2 * out_.size()))));
  }
  return std::span(out_).subspan(filled_, std::min(out_.size(), size + 1) - filled_);
}

ChunkUnpacker::Step ChunkUnpacker::copy_step(Bytes in, std::span<std::uint8_t> room) {
  const std::size_t count = std::min(in.size(), room.size());
  if (count > 0) std::memcpy(room.data(), in.data(), count);
  return {count, count, true, false};
}

ChunkUnpacker::Step ChunkUnpacker::zstd_step(Bytes in, std::span<std::uint8_t> room) {
  ZSTD_inBuffer from{in.data(), in.size(), 0};
  ZSTD_outBuffer to{room.data(), room.size(), 0};
  const std::size_t result = ZSTD_decompressStream(zstd_.get(), &to, &from);
  return {from.pos, to.pos, result == 0, ZSTD_isError(result) != 0};
}

ChunkUnpacker::Step ChunkUnpacker::lz4_step(Bytes in, std::span<std::uint8_t> room) {
  std::size_t in_size = in.size();
  std::size_t out_size = room.size();
  const std::size_t result =
      LZ4F_decompress(lz4_.get(), room.data(), &out_size, in.data(), &in_size, nullptr);
  if (LZ4F_isError(result) != 0) return {0, 0, false, true};
  return {in_size, out_size, result == 0, false};
}

}  // namespace dynslam
