// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "io/byte_sink.h"
#include "io/byte_writer.h"
#include "io/mcap_format.h"

struct ZSTD_CCtx_s;

namespace dynslam {

/// What a channel carries: messages in CDR, laid out as `schema` says (.msg text of ROS 2).
struct McapTopic {
  std::string topic;
  std::string schema_name;
  std::string schema;
  std::map<std::string, std::string> metadata = {};
};

/// Writes an MCAP file (version 0, profile `ros2`): messages in chunks packed with zstd, each with its index
/// behind it, and at the end the index of all. A file that was never finished is good up to its last chunk.
/// Memory: a chunk, and some 250 bytes for each one written.
///
/// The sink takes a piece whole or throws; then it is as if the call had not been, and the open chunk is
/// still there, to be closed once more or dropped. One thread at a time.
class McapWriter {
 public:
  using Metadata = std::map<std::string, std::string>;

  explicit McapWriter(ByteSink sink);
  ~McapWriter();

  /// The file's head. REQUIRES: once, before everything else.
  void begin(std::string_view library, std::string_view name, const Metadata& about);

  std::uint16_t add_channel(const McapTopic& topic);

  /// REQUIRES: a channel of this writer.
  void add_message(std::uint16_t channel, std::uint64_t log_time_ns, std::uint64_t publish_time_ns,
                   std::string_view data);

  /// Bytes that wait in the open chunk, unpacked.
  std::size_t waiting() const { return chunk_.size(); }
  /// Writes what waits, if anything does.
  void close_chunk();
  /// Gives up what waits. Afterwards only finish() makes sense.
  void drop_chunk();

  /// The index and the end mark. REQUIRES: nothing waits.
  void finish();

  std::uint64_t bytes() const { return bytes_; }       ///< written so far
  std::uint64_t messages() const { return written_; }  ///< in them

 private:
  struct Span {  ///< of log times
    std::uint64_t first_ns = std::numeric_limits<std::uint64_t>::max();
    std::uint64_t last_ns = 0;
    void take(std::uint64_t t_ns);
  };
  struct Channel {
    std::string schema, record;  ///< as in the file
    std::uint32_t next_sequence = 0;
    std::uint64_t messages = 0;
    ByteWriter index;  ///< of the open chunk: log time, offset
  };
  struct ChunkInfo {
    Span span;
    std::uint64_t at = 0, size = 0, packed = 0, unpacked = 0, index_size = 0;
    std::vector<std::pair<std::uint16_t, std::uint64_t>> indexes;  ///< channel, where in the file
  };
  void put(std::string_view bytes);
  std::string_view pack();
  void append_indexes(ByteWriter& out, ChunkInfo& info) const;
  std::string statistics() const;
  std::string summary(std::uint64_t begin) const;

  ByteSink sink_;
  struct FreeZstd {
    void operator()(ZSTD_CCtx_s* context) const;
  };
  std::unique_ptr<ZSTD_CCtx_s, FreeZstd> zstd_;
  std::vector<Channel> channels_;  ///< by id - 1
  std::size_t channels_written_ = 0;
  std::vector<ChunkInfo> chunks_;
  ByteWriter chunk_;
  Span chunk_span_;
  std::uint64_t chunk_messages_ = 0;
  std::string packed_;
  std::uint64_t bytes_ = 0, written_ = 0;
  std::uint32_t crc_ = 0;
  std::string metadata_index_;
};

}  // namespace dynslam
