// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/counters.h"
#include "io/byte_cursor.h"
#include "io/byte_source.h"
#include "io/chunk_unpacker.h"
#include "io/mcap_format.h"

namespace dynslam {

struct McapRecord {
  McapOpcode opcode;
  Bytes content;  ///< valid until the next call of the stream
};

/// The schemas, channels and messages of an MCAP file (version 0) in the order of the file, chunks opened on
/// the way. Indexes, attachments, metadata and the summary are passed over. A damaged chunk costs that chunk
/// and sets fault(). Memory: the largest chunk or record, at most `kMaxSize`; what is larger is passed over
/// and counted.
class McapStream {
 public:
  static constexpr std::uint64_t kMaxSize = 256 << 20;  ///< bytes, unpacked

  /// Keeps references. The source must begin with the magic bytes.
  McapStream(ByteSource& source, Counters& counters);

  std::optional<McapRecord> next();

  /// The first fault: what is wrong at which byte. Empty for a sound file.
  const std::string& fault() const { return fault_; }

 private:
  struct Head {
    McapOpcode opcode;
    std::uint64_t at;      ///< byte offset of the record
    std::uint64_t length;  ///< of its content; the file has all of it, unless it is a chunk
  };
  std::optional<McapRecord> next_in_chunk();
  std::optional<Head> read_head();
  std::optional<McapRecord> read_record(const Head& head);
  void open_chunk(const Head& head);
  bool is_chunk_sound(const Head& head, UnpackResult result, std::uint32_t crc);
  void end_in_chunk(const Head& head);
  void lose_chunk(const Head& head, const std::string& why);
  void fail(std::uint64_t at, const std::string& why);

  ByteSource& source_;
  Counters& counters_;
  ChunkUnpacker unpacker_;
  std::optional<ByteCursor> chunk_;
  std::uint64_t chunk_at_ = 0;
  std::vector<std::uint8_t> record_;
  bool ended_ = false;
  std::string fault_;
};

}  // namespace dynslam
