// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include "io/cdr.h"
#include "io/mcap_format.h"

namespace dynslam::test {

/// The bytes of a number, least significant first.
template <class T>
std::string le(T value) {
  return ByteWriter().number(value).bytes();
}

inline std::string le_text(std::string_view text) { return ByteWriter().text(text).bytes(); }

using dynslam::CdrWriter;

inline CdrWriter& put_header(CdrWriter& cdr, std::int64_t stamp_ns, std::string_view frame) {
  cdr.put(static_cast<std::int32_t>(stamp_ns / 1'000'000'000));
  cdr.put(static_cast<std::uint32_t>(stamp_ns % 1'000'000'000));
  return cdr.text(frame);
}

struct LaserScanFields {
  std::int64_t stamp_ns = 1'000'000'000;
  std::string frame = "laser";
  float angle_min = -1.0F;
  float angle_increment = 0.5F;
  float time_increment = 0.001F;
  float range_min = 0.1F;
  float range_max = 12.0F;
  std::vector<float> ranges = {1.0F, 2.0F, 3.0F};
  bool big_endian = false;
};

inline std::string laser_scan(const LaserScanFields& f) {
  const float last = f.angle_min + f.angle_increment * static_cast<float>(f.ranges.size());
  CdrWriter cdr(f.big_endian ? std::endian::big : std::endian::little);
  put_header(cdr, f.stamp_ns, f.frame)
      .put(f.angle_min)
      .put(last)
      .put(f.angle_increment)
      .put(f.time_increment);
  return cdr.put(0.1F).put(f.range_min).put(f.range_max).floats(f.ranges).floats({}).bytes();
}

struct Quaternion {
  double x = 0.0, y = 0.0, z = 0.0, w = 1.0;
};

inline std::string imu(std::int64_t stamp_ns, const Quaternion& q, double covariance = 0.0,
                       std::string_view frame = "imu") {
  CdrWriter cdr;
  put_header(cdr, stamp_ns, frame).put_all({q.x, q.y, q.z, q.w}).put(covariance);
  for (int i = 0; i < 8 + 3 + 9 + 3 + 9; ++i) cdr.put(0.0);
  return cdr.bytes();
}

inline std::string odometry(std::int64_t stamp_ns, double x, double y, const Quaternion& q) {
  CdrWriter cdr;
  put_header(cdr, stamp_ns, "odom").text("base_link").put_all({x, y, 0.0, q.x, q.y, q.z, q.w});
  for (int i = 0; i < 36 + 6 + 36; ++i) cdr.put(0.0);
  return cdr.bytes();
}

struct TransformFields {
  std::string parent, child;
  double x = 0.0, y = 0.0, z = 0.0;
  Quaternion q = {};
};

inline std::string transforms(const std::vector<TransformFields>& all) {
  CdrWriter cdr;
  cdr.put(static_cast<std::uint32_t>(all.size()));
  for (const TransformFields& t : all) {
    put_header(cdr, 0, t.parent).text(t.child).put_all({t.x, t.y, t.z, t.q.x, t.q.y, t.q.z, t.q.w});
  }
  return cdr.bytes();
}

/// Writes an MCAP file in memory.
class McapBuilder {
 public:
  struct Options {
    std::optional<std::string> compression = "zstd";  ///< "", "zstd" or "lz4"; nothing: no chunks
    std::size_t messages_per_chunk = 4;
    bool has_crc = true;
    bool has_summary = true;
  };

  McapBuilder() : McapBuilder(Options{}) {}
  explicit McapBuilder(Options options) : options_(std::move(options)), file_(magic()) {
    file_ += record(McapOpcode::kHeader, le_text("ros2") + le_text("dynslam test"));
  }

  static std::string magic() { return std::string(kMcapMagic); }
  static std::string record(McapOpcode opcode, std::string_view content) {
    return record(static_cast<std::uint8_t>(opcode), content);
  }
  static std::string record(std::uint8_t opcode, std::string_view content) {
    return static_cast<char>(opcode) + le(static_cast<std::uint64_t>(content.size())) + std::string(content);
  }

  std::uint16_t add_channel(std::string_view topic, std::string_view schema,
                            std::string_view encoding = "cdr") {
    const auto id = static_cast<std::uint16_t>(++channels_);
    const std::string definition =
        record(McapOpcode::kSchema, le(id) + le_text(schema) + le_text("ros2msg") + le_text("# whatever")) +
        record(McapOpcode::kChannel,
               le(id) + le(id) + le_text(topic) + le_text(encoding) + le(std::uint32_t{0}));
    definitions_ += definition;
    add_records(definition);
    return id;
  }

  void add_message(std::uint16_t channel, std::uint64_t log_time_ns, std::string_view data) {
    add_records(record(
        0x05, le(channel) + le(std::uint32_t{0}) + le(log_time_ns) + le(log_time_ns) + std::string(data)));
    if (++messages_ % options_.messages_per_chunk == 0) end_chunk();
  }

  /// Whatever bytes, into the open chunk or, without chunks, into the file.
  void add_records(std::string_view bytes) { (options_.compression ? chunk_ : file_) += bytes; }

  /// Whatever bytes, into the file itself.
  void add_outside(std::string_view bytes) {
    end_chunk();
    file_ += bytes;
  }

  void end_chunk() {
    if (chunk_.empty()) return;
    file_ += chunk_record(chunk_, *options_.compression, options_.has_crc);
    file_ += record(McapOpcode::kMessageIndex, le(std::uint16_t{1}) + le(std::uint32_t{0}));
    chunk_.clear();
  }

  /// All bytes; `data_end()` tells where the part that counts is over.
  std::string finish() {
    end_chunk();
    data_end_ = file_.size();
    file_ += record(McapOpcode::kDataEnd, le(std::uint32_t{0}));
    if (options_.has_summary) file_ += definitions_ + record(McapOpcode::kStatistics, std::string(46, '\0'));
    file_ += record(McapOpcode::kFooter, std::string(20, '\0')) + magic();
    return file_;
  }
  std::size_t data_end() const { return data_end_; }

  static std::string chunk_record(std::string_view records, std::string_view compression,
                                  bool has_crc = true) {
    const uLong crc =
        crc32(0, reinterpret_cast<const Bytef*>(records.data()), static_cast<uInt>(records.size()));
    return chunk_record_of(pack(records, compression), records.size(),
                           has_crc ? static_cast<std::uint32_t>(crc) : 0, compression);
  }
  static std::string chunk_record_of(std::string_view packed, std::uint64_t size, std::uint32_t crc,
                                     std::string_view compression) {
    return record(McapOpcode::kChunk,
                  le(std::uint64_t{0}) + le(std::uint64_t{0}) + le(size) + le(crc) + le_text(compression) +
                      le(static_cast<std::uint64_t>(packed.size())) + std::string(packed));
  }

  static std::string pack(std::string_view bytes, std::string_view compression) {
    if (compression == "zstd") {
      std::string packed(ZSTD_compressBound(bytes.size()), '\0');
      packed.resize(ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 1));
      return packed;
    }
    if (compression == "lz4") {
      std::string packed(LZ4F_compressFrameBound(bytes.size(), nullptr), '\0');
      packed.resize(LZ4F_compressFrame(packed.data(), packed.size(), bytes.data(), bytes.size(), nullptr));
      return packed;
    }
    return std::string(bytes);
  }

 private:
  Options options_;
  std::string file_;
  std::string chunk_;
  std::string definitions_;
  int channels_ = 0;
  std::size_t messages_ = 0;
  std::size_t data_end_ = 0;
};

}  // namespace dynslam::test
