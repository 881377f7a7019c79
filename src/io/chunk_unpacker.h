// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "io/byte_cursor.h"
#include "io/byte_source.h"

struct ZSTD_DCtx_s;
struct LZ4F_dctx_s;

namespace dynslam {

enum class UnpackResult {
  kWhole,
  kCutOff,       ///< the source ended early; what was unpacked until then is good
  kDamaged,      ///< not of that compression, or not of the promised size
  kUnsupported,  ///< a compression that nobody here knows
};

/// Unpacks the chunks of an MCAP file as they stream in. Memory grows with what really comes out, never with
/// what was promised, and stays for the next chunk.
class ChunkUnpacker {
 public:
  ChunkUnpacker();
  ~ChunkUnpacker();

  /// Reads `packed_size` bytes from the source, which must unpack to `size` bytes. `compression`: "", "zstd"
  /// or "lz4".
  UnpackResult unpack(ByteSource& source, std::uint64_t packed_size, std::string_view compression,
                      std::size_t size);

  /// What came out last; valid until the next unpack().
  Bytes bytes() const { return {out_.data(), filled_}; }

 private:
  /// Unpacks from `in` into `room`: how much of both was used, and whether a frame has just ended.
  struct Step {
    std::size_t in = 0;
    std::size_t out = 0;
    bool frame_ended = false;
    bool failed = false;
  };
  using Stepper = Step (ChunkUnpacker::*)(Bytes in, std::span<std::uint8_t> room);

  Step copy_step(Bytes in, std::span<std::uint8_t> room);
  Step zstd_step(Bytes in, std::span<std::uint8_t> room);
  Step lz4_step(Bytes in, std::span<std::uint8_t> room);
  bool feed(Stepper stepper, Bytes in, std::size_t size);
  std::span<std::uint8_t> room_up_to(std::size_t size);

  struct FreeZstd {
    void operator()(ZSTD_DCtx_s* context) const;
  };
  struct FreeLz4 {
    void operator()(LZ4F_dctx_s* context) const;
  };
  std::unique_ptr<ZSTD_DCtx_s, FreeZstd> zstd_;
  std::unique_ptr<LZ4F_dctx_s, FreeLz4> lz4_;
  std::vector<std::uint8_t> in_;
  std::vector<std::uint8_t> out_;
  std::size_t filled_ = 0;
  bool in_frame_ = false;
};

}  // namespace dynslam
