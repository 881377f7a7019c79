// SPDX-License-Identifier: MIT
#include "io/mcap_writer.h"

#include <algorithm>
#include <new>
#include <stdexcept>
#include <utility>

#include <zlib.h>
#include <zstd.h>

namespace dynslam {
namespace {

constexpr std::string_view kCompression = "zstd";
constexpr int kLevel = 1;  // ranges are noise: higher levels take more time and save next to nothing

std::uint32_t crc_of(std::string_view bytes, std::uint32_t so_far = 0) {
  return static_cast<std::uint32_t>(
      crc32_z(so_far, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

void append_record(ByteWriter& out, McapOpcode opcode, std::string_view content) {
  out.number(static_cast<std::uint8_t>(opcode)).number(std::uint64_t{content.size()}).raw(content);
}

void append_map(ByteWriter& out, const std::map<std::string, std::string>& map) {
  ByteWriter entries;
  for (const auto& [key, value] : map) entries.text(key).text(value);
  out.text(entries.bytes());
}

}  // namespace

void McapWriter::FreeZstd::operator()(ZSTD_CCtx_s* context) const { ZSTD_freeCCtx(context); }

McapWriter::McapWriter(ByteSink sink) : sink_(std::move(sink)), zstd_(ZSTD_createCCtx()) {
  if (!zstd_) throw std::bad_alloc();
}

McapWriter::~McapWriter() = default;

void McapWriter::Span::take(std::uint64_t t_ns) {
  first_ns = std::min(first_ns, t_ns);
  last_ns = std::max(last_ns, t_ns);
}

/// The checksum of the data goes up to the end of it.
void McapWriter::put(std::string_view bytes) {
  sink_(bytes);
  bytes_ += bytes.size();
  crc_ = crc_of(bytes, crc_);
}

void McapWriter::begin(std::string_view library, std::string_view name, const Metadata& about) {
  ByteWriter out, header, metadata;
  header.text("ros2").text(library);
  out.raw(kMcapMagic);
  append_record(out, McapOpcode::kHeader, header.bytes());
  const std::uint64_t at = out.size();
  metadata.text(name);
  append_map(metadata, about);
  append_record(out, McapOpcode::kMetadata, metadata.bytes());
  ByteWriter index;
  index.number(at).number(std::uint64_t{out.size() - at}).text(name);
  metadata_index_ = index.bytes();
  put(out.bytes());
}

/// Each channel has a schema of its own, of the same number, so that no record refers to what a chunk that
/// was lost would have said.
std::uint16_t McapWriter::add_channel(const McapTopic& topic) {
  const auto id = static_cast<std::uint16_t>(channels_.size() + 1);
  if (id == 0) throw std::length_error("an MCAP file has 65535 channels at most");
  ByteWriter schema, channel, records;
  schema.number(id).text(topic.schema_name).text("ros2msg").text(topic.schema);
  channel.number(id).number(id).text(topic.topic).text("cdr");
  append_map(channel, topic.metadata);
  Channel added;
  append_record(records, McapOpcode::kSchema, schema.bytes());
  added.schema = records.bytes();
  records.clear();
  append_record(records, McapOpcode::kChannel, channel.bytes());
  added.record = records.bytes();
  chunk_.raw(added.schema).raw(added.record);
  channels_.push_back(std::move(added));
  return id;
}

void McapWriter::add_message(std::uint16_t channel, std::uint64_t log_time_ns, std::uint64_t publish_time_ns,
                             std::string_view data) {
  constexpr std::uint64_t kOwnSize = 2 + 4 + 8 + 8;
  Channel& on = channels_.at(channel - 1U);
  on.index.number(log_time_ns).number(std::uint64_t{chunk_.size()});
  chunk_.number(static_cast<std::uint8_t>(McapOpcode::kMessage)).number(kOwnSize + data.size());
  chunk_.number(channel).number(on.next_sequence++).number(log_time_ns).number(publish_time_ns).raw(data);
  chunk_span_.take(log_time_ns);
  ++chunk_messages_;
}

std::string_view McapWriter::pack() {
  packed_.resize(std::max(packed_.size(), ZSTD_compressBound(chunk_.size())));
  const std::size_t size = ZSTD_compressCCtx(zstd_.get(), packed_.data(), packed_.size(),
                                             chunk_.bytes().data(), chunk_.size(), kLevel);
  if (ZSTD_isError(size) != 0) throw std::runtime_error(std::string("zstd: ") + ZSTD_getErrorName(size));
  return {packed_.data(), size};
}

void McapWriter::close_chunk() {
  if (chunk_.size() == 0) return;
  const std::string_view packed = pack();
  ChunkInfo info;
  if (chunk_messages_ > 0) info.span = chunk_span_;
  if (chunk_messages_ == 0) info.span.first_ns = 0;
  info.at = bytes_;
  info.packed = packed.size();
  info.unpacked = chunk_.size();
  ByteWriter content, out;
  content.number(info.span.first_ns).number(info.span.last_ns).number(info.unpacked);
  content.number(crc_of(chunk_.bytes())).text(kCompression).number(info.packed).raw(packed);
  append_record(out, McapOpcode::kChunk, content.bytes());
  info.size = out.size();
  append_indexes(out, info);
  put(out.bytes());

  for (Channel& channel : channels_) {
    channel.messages += channel.index.size() / (2 * sizeof(std::uint64_t));
    channel.index.clear();
  }
  chunks_.push_back(std::move(info));
  channels_written_ = channels_.size();
  written_ += chunk_messages_;
  chunk_.clear();
  chunk_span_ = {};
  chunk_messages_ = 0;
}

void McapWriter::append_indexes(ByteWriter& out, ChunkInfo& info) const {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    if (channels_[i].index.size() == 0) continue;
    const auto id = static_cast<std::uint16_t>(i + 1);
    info.indexes.emplace_back(id, info.at + out.size());
    ByteWriter index;
    index.number(id).text(channels_[i].index.bytes());
    append_record(out, McapOpcode::kMessageIndex, index.bytes());
  }
  info.index_size = out.size() - info.size;
}

void McapWriter::drop_chunk() {
  channels_.resize(channels_written_);
  for (Channel& channel : channels_) channel.index.clear();
  chunk_.clear();
  chunk_span_ = {};
  chunk_messages_ = 0;
}

void McapWriter::finish() {
  ByteWriter end;
  append_record(end, McapOpcode::kDataEnd, ByteWriter().number(crc_).bytes());
  end.raw(summary(bytes_ + end.size())).raw(kMcapMagic);
  put(end.bytes());
}

}  // namespace dynslam
