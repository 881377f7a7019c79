// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "pipe/clock.h"
#include "robot/ports.h"
#include "server/map_delivery.h"

namespace dynslam {

/// The state as text, made once for all who watch. Any thread.
class StateFeed {
 public:
  using SteadyTime = Clock::SteadyTime;
  static constexpr std::chrono::milliseconds kEvery{100};

  StateFeed(const Ports& ports, std::function<std::string()> make) : ports_(ports), make_(std::move(make)) {}

  /// Not older than half of kEvery, and with the newest scan.
  std::string get(SteadyTime now);
  /// Changes when there is a new one.
  std::uint64_t scan() const { return ports_.scan.get().version; }

 private:
  const Ports& ports_;
  std::function<std::string()> make_;
  std::mutex mutex_;
  std::string text_;
  std::optional<SteadyTime> made_;
  std::uint64_t scan_ = 0;  ///< that text_ has
};

/// The map as it is sent, its versions counted once for all who watch. Any thread.
class MapFeed {
 public:
  MapFeed(const Ports& ports, const Clock& clock, std::uint64_t map_id)
      : ports_(ports), clock_(clock), map_id_(map_id) {}

  std::uint64_t map_id() const { return map_id_; }
  /// The next message for a client; nothing when it has all there is, and is `told` so.
  std::optional<std::string> next(MapDelivery& delivery, std::size_t most_chunks, bool told);

 private:
  const Ports& ports_;
  const Clock& clock_;
  std::uint64_t map_id_;
  std::mutex mutex_;
  MapVersions versions_;
  std::uint64_t world_version_ = 0;
};

}  // namespace dynslam
