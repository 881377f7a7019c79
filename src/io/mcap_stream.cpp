// SPDX-License-Identifier: MIT
#include "io/mcap_stream.h"

#include <algorithm>
#include <limits>

#include <zlib.h>

namespace dynslam {
namespace {

constexpr std::size_t kMaxChunkHead = 64;  // a name of 24 characters; the known ones have four at most

bool is_wanted(McapOpcode opcode) {
  return opcode == McapOpcode::kSchema || opcode == McapOpcode::kChannel || opcode == McapOpcode::kMessage;
}

struct ChunkHead {
  std::uint64_t size = 0;  ///< of the records, unpacked
  std::uint32_t crc = 0;   ///< of the same; 0: unknown
  std::string compression;
  std::uint64_t packed_size = 0;
  std::uint64_t own_size = 0;  ///< how many bytes come before the packed records
};

// start time, end time, unpacked size (64 bits each), checksum (32), name of the compression (text), packed
// size (64)
std::optional<ChunkHead> parse_chunk_head(Bytes bytes) {
  ByteCursor fields(bytes);
  ChunkHead head;
  fields.take(16);
  head.size = fields.number<std::uint64_t>();
  head.crc = fields.number<std::uint32_t>();
  head.compression = fields.text();
  head.packed_size = fields.number<std::uint64_t>();
  head.own_size = fields.position();
  if (!fields.ok()) return std::nullopt;
  return head;
}

std::uint32_t crc_of(Bytes bytes) {
  static_assert(McapStream::kMaxSize <= std::numeric_limits<uInt>::max());
  return static_cast<std::uint32_t>(crc32(0, bytes.data(), static_cast<uInt>(bytes.size())));
}

}  // namespace

McapStream::McapStream(ByteSource& source, Counters& counters) : source_(source), counters_(counters) {
  source_.seek(kMcapMagic.size());
}

std::optional<McapRecord> McapStream::next() {
  while (true) {
    if (chunk_) {
      if (auto record = next_in_chunk()) return record;
      chunk_.reset();
    }
    if (ended_) return std::nullopt;
    const std::optional<Head> head = read_head();
    if (!head) return std::nullopt;
    if (head->opcode == McapOpcode::kDataEnd || head->opcode == McapOpcode::kFooter) {
      ended_ = true;
    } else if (head->opcode == McapOpcode::kChunk) {
      open_chunk(*head);
    } else if (is_wanted(head->opcode)) {
      if (auto record = read_record(*head)) return record;
    } else {
      source_.seek(source_.position() + head->length);
    }
  }
}

std::optional<McapRecord> McapStream::next_in_chunk() {
  while (chunk_->remaining() > 0) {
    const auto opcode = static_cast<McapOpcode>(chunk_->number<std::uint8_t>());
    const auto length = chunk_->number<std::uint64_t>();
    const Bytes content = chunk_->take(length);
    if (!chunk_->ok()) {
      // In a chunk that was cut off this is where the file ends, which is said already.
      fail(chunk_at_, "a record reaches past the end of its chunk");
      return std::nullopt;
    }
    if (is_wanted(opcode)) return McapRecord{opcode, content};
  }
  return std::nullopt;
}

/// Nothing at the end, sound or not. A chunk may be cut off, since what it begins with is still good; any
/// other record that the file has not all of is the end.
std::optional<McapStream::Head> McapStream::read_head() {
  const std::uint64_t at = source_.position();
  std::uint8_t raw[kMcapRecordHead] = {};
  const std::size_t got = source_.read(raw, kMcapRecordHead);
  const Head head{static_cast<McapOpcode>(raw[0]), at,
                  got == kMcapRecordHead ? load<std::uint64_t>(raw + 1, std::endian::little) : 0};
  if (!source_.fault().empty()) {
    fail(at, source_.fault());
  } else if (got == 0) {
    fail(at, "the file ends before its end mark");
  } else if (got < kMcapRecordHead) {
    fail(at, "the file ends inside a record");
  } else if (raw[0] == 0) {
    fail(at, "no record begins here");
  } else if (head.length > source_.remaining() && head.opcode != McapOpcode::kChunk) {
    fail(at, "a record reaches past the end of the file");
  } else {
    return head;
  }
  ended_ = true;
  return std::nullopt;
}

std::optional<McapRecord> McapStream::read_record(const Head& head) {
  if (head.length > kMaxSize) {
    counters_.add("mcap.too_large");
    source_.seek(source_.position() + head.length);
    return std::nullopt;
  }
  record_.resize(static_cast<std::size_t>(head.length));
  if (source_.read(record_.data(), record_.size()) < record_.size()) {
    fail(head.at, source_.fault().empty() ? "the file ends inside a record" : source_.fault());
    ended_ = true;
    return std::nullopt;
  }
  return McapRecord{head.opcode, record_};
}

void McapStream::open_chunk(const Head& head) {
  const std::uint64_t begin = source_.position();
  const bool is_cut = head.length > source_.remaining();
  std::uint8_t raw[kMaxChunkHead];
  const std::uint64_t want = std::min<std::uint64_t>(kMaxChunkHead, head.length);
  const std::size_t got = source_.read(raw, static_cast<std::size_t>(want));
  const std::optional<ChunkHead> chunk = parse_chunk_head(Bytes(raw, got));
  chunk_at_ = head.at;

  if (!chunk && got < want) {
    end_in_chunk(head);
  } else if (!chunk || chunk->own_size > head.length || chunk->packed_size > head.length - chunk->own_size) {
    lose_chunk(head, "the chunk's header makes no sense");
  } else if (chunk->size > kMaxSize) {
    lose_chunk(head, "the chunk is larger than 256 MiB");
  } else {
    source_.seek(begin + chunk->own_size);
    const auto size = static_cast<std::size_t>(chunk->size);
    const UnpackResult result = unpacker_.unpack(source_, chunk->packed_size, chunk->compression, size);
    if (is_chunk_sound(head, result, chunk->crc)) chunk_.emplace(unpacker_.bytes());
  }
  if (is_cut) end_in_chunk(head);
  if (!ended_) source_.seek(begin + head.length);
}

void McapStream::end_in_chunk(const Head& head) {
  fail(head.at, source_.fault().empty() ? "the file ends inside a chunk" : source_.fault());
  ended_ = true;
}

bool McapStream::is_chunk_sound(const Head& head, UnpackResult result, std::uint32_t crc) {
  switch (result) {
    case UnpackResult::kCutOff:
      end_in_chunk(head);
      return true;
    case UnpackResult::kDamaged:
      lose_chunk(head, "the chunk does not unpack");
      return false;
    case UnpackResult::kUnsupported:
      lose_chunk(head, "the chunk's compression is not known (known are none, lz4 and zstd)");
      return false;
    case UnpackResult::kWhole:
      break;
  }
  if (crc == 0 || crc == crc_of(unpacker_.bytes())) return true;
  counters_.add("mcap.bad_crc");
  lose_chunk(head, "the chunk's checksum is wrong");
  return false;
}

void McapStream::lose_chunk(const Head& head, const std::string& why) {
  counters_.add("mcap.lost_chunks");
  fail(head.at, why);
}

void McapStream::fail(std::uint64_t at, const std::string& why) {
  if (fault_.empty()) fault_ = why + " at byte " + std::to_string(at);
}

}  // namespace dynslam
