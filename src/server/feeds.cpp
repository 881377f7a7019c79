// SPDX-License-Identifier: MIT
#include "server/feeds.h"

namespace dynslam {

std::string StateFeed::get(SteadyTime now) {
  const std::lock_guard lock(mutex_);
  const std::uint64_t scan = this->scan();
  if (!made_ || scan != scan_ || now - *made_ >= kEvery / 2) {
    text_ = make_();
    made_ = now;
    scan_ = scan;
  }
  return text_;
}

std::optional<std::string> MapFeed::next(MapDelivery& delivery, std::size_t most_chunks, bool told) {
  std::unique_lock lock(mutex_);
  const auto world =
      ports_.world.get();  // never older than versions_, which would name chunks that it has not
  if (!world.value) return std::nullopt;
  const GridSnapshot& map = world.value->map;
  const CellIndex robot = cell_at(world.value->pose.map_T_robot.translation(), map.cell_size_m());
  MapMessage message{map_id_, clock_.now(), static_cast<float>(map.cell_size_m()), false};
  if (world.version > world_version_) {
    versions_.update(map, message.sent);
    world_version_ = world.version;
  }
  const std::vector<MapDelivery::Pick> picks = delivery.next(versions_, chunk_of(robot), most_chunks);
  message.all_sent = delivery.round_done();
  lock.unlock();
  if (picks.empty() && told) return std::nullopt;
  std::vector<CodedChunk> chunks;
  chunks.reserve(picks.size());
  for (const auto& [index, entry] : picks)
    chunks.push_back({index, entry.version, entry.changed, code_cells(*map.find(index))});
  return to_bytes(message, chunks);
}

}  // namespace dynslam
