// SPDX-License-Identifier: MIT
// What an MCAP file ends with: where everything is, for those who do not want to read all of it.
#include <zlib.h>

#include "io/mcap_writer.h"

namespace dynslam {
namespace {

/// The summary as it grows: groups of like records, and where each group is.
class Groups {
 public:
  explicit Groups(std::uint64_t begin) : begin_(begin) {}

  void add(McapOpcode opcode, std::string_view content) {
    open(opcode);
    out_.number(static_cast<std::uint8_t>(opcode)).number(std::uint64_t{content.size()}).raw(content);
  }
  /// One that has its head already.
  void add_record(McapOpcode opcode, std::string_view record) {
    open(opcode);
    out_.raw(record);
  }

  /// Where the groups are, then the footer with the checksum of it all.
  std::string finish() {
    close();
    const std::uint64_t offsets_at = begin_ + out_.size();
    for (const std::string& offset : offsets_) add_offset(offset);
    constexpr std::uint64_t kFooterSize = 8 + 8 + 4;
    out_.number(static_cast<std::uint8_t>(McapOpcode::kFooter)).number(kFooterSize);
    out_.number(begin_).number(offsets_at);
    const auto* bytes = reinterpret_cast<const Bytef*>(out_.bytes().data());
    out_.number(static_cast<std::uint32_t>(crc32_z(0, bytes, out_.size())));
    return out_.bytes();
  }

 private:
  void open(McapOpcode opcode) {
    if (opcode == opcode_) return;
    close();
    opcode_ = opcode;
    group_at_ = out_.size();
  }
  void close() {
    if (out_.size() == group_at_) return;
    ByteWriter offset;
    offset.number(static_cast<std::uint8_t>(opcode_)).number(begin_ + group_at_);
    offset.number(std::uint64_t{out_.size() - group_at_});
    offsets_.push_back(offset.bytes());
  }
  void add_offset(std::string_view content) {
    out_.number(static_cast<std::uint8_t>(McapOpcode::kSummaryOffset));
    out_.number(std::uint64_t{content.size()}).raw(content);
  }

  std::uint64_t begin_;
  ByteWriter out_;
  McapOpcode opcode_{};
  std::uint64_t group_at_ = 0;
  std::vector<std::string> offsets_;
};

}  // namespace

std::string McapWriter::statistics() const {
  Span span;
  for (const ChunkInfo& chunk : chunks_) {
    if (chunk.indexes.empty()) continue;
    span.take(chunk.span.first_ns);
    span.take(chunk.span.last_ns);
  }
  if (written_ == 0) span.first_ns = 0;
  ByteWriter counts, out;
  for (std::size_t i = 0; i < channels_.size(); ++i)
    counts.number(static_cast<std::uint16_t>(i + 1)).number(channels_[i].messages);
  out.number(written_).number(static_cast<std::uint16_t>(channels_.size()));
  out.number(static_cast<std::uint32_t>(channels_.size()));
  out.number(std::uint32_t{0}).number(std::uint32_t{1});  // attachments, metadata
  out.number(static_cast<std::uint32_t>(chunks_.size())).number(span.first_ns).number(span.last_ns);
  return out.text(counts.bytes()).bytes();
}

std::string McapWriter::summary(std::uint64_t begin) const {
  Groups groups(begin);
  for (const Channel& c : channels_) groups.add_record(McapOpcode::kSchema, c.schema);
  for (const Channel& c : channels_) groups.add_record(McapOpcode::kChannel, c.record);
  groups.add(McapOpcode::kStatistics, statistics());
  for (const ChunkInfo& chunk : chunks_) {
    ByteWriter offsets, out;
    for (const auto& [channel, at] : chunk.indexes) offsets.number(channel).number(at);
    out.number(chunk.span.first_ns).number(chunk.span.last_ns).number(chunk.at).number(chunk.size);
    out.text(offsets.bytes()).number(chunk.index_size).text("zstd");
    groups.add(McapOpcode::kChunkIndex, out.number(chunk.packed).number(chunk.unpacked).bytes());
  }
  groups.add(McapOpcode::kMetadataIndex, metadata_index_);
  return groups.finish();
}

}  // namespace dynslam
