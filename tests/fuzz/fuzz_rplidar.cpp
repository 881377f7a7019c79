// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdlib>

#include "drivers/rplidar/messages.h"
#include "drivers/rplidar/packet_stream.h"
#include "drivers/rplidar/turn_builder.h"

namespace {

using namespace dynslam;
using namespace dynslam::rplidar;

void parse_answers(ByteView bytes) {
  parse_head(bytes);
  if (const auto info = parse_info(bytes)) info->model_name();
  if (const auto health = parse_health(bytes)) in_words(*health);
  for (const ConfItem item : {ConfItem::kModeCount, ConfItem::kSampleTime}) {
    if (const auto data = parse_conf(bytes, item)) parse_sample_us(*data);
  }
  parse_count(bytes);
  parse_max_range_m(bytes);
  parse_answer_type(bytes);
  parse_name(bytes);
  legacy_modes(bytes);
}

void expect_sane(const Sample& sample) {
  const bool sane = sample.range_m > 0.0F && sample.turned_deg > -361.0F && sample.turned_deg < 366.0F &&
                    std::abs(sample.angle_deg - sample.turned_deg) < 361.0F;
  if (!sane) std::abort();
}

void expect_sane(const Scan& scan) {
  for (std::size_t i = 1; i < scan.beams.size(); ++i) {
    if (scan.beams[i].time_s < scan.beams[i - 1].time_s) std::abort();
  }
}

}  // namespace

// The first byte says what kind of packets, the others come down the line: in whatever pieces, the same beams
// come out.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  const ByteView bytes(data + 1, size - 1);
  parse_answers(bytes);
  const PacketForm* form = find_form(static_cast<AnswerType>(0x81 + data[0] % 6));
  const StreamForm line{form, std::chrono::microseconds(63), 256000, {}};
  PacketStream whole(line), pieces(line);
  std::vector<Sample> from_whole, from_pieces;
  whole.feed(bytes, Time(std::chrono::seconds(1)), from_whole);
  Time now(std::chrono::seconds(1));
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t n = std::min<std::size_t>(1 + bytes[at] % 150, bytes.size() - at);
    now += std::chrono::milliseconds(bytes[at] % 16);
    pieces.feed(bytes.subspan(at, n), now, from_pieces);
    at += n;
  }
  if (from_whole.size() != from_pieces.size()) std::abort();
  TurnBuilder builder{LidarMount{}};
  for (std::size_t i = 0; i < from_whole.size(); ++i) {
    expect_sane(from_whole[i]);
    if (from_whole[i].range_m != from_pieces[i].range_m ||
        from_whole[i].angle_deg != from_pieces[i].angle_deg)
      std::abort();
    if (const auto scan = builder.add(from_pieces[i])) expect_sane(*scan);
  }
  return 0;
}
