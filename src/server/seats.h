// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace dynslam {

/// Who may hold one of the server's threads, of which there are few: each connection takes one for as long as
/// it lasts. Pure; the caller locks.
///
/// - An address gets a share of the seats.
/// - The last ones are kept: only STOP and `control` get them. When it comes to these, connections that have
///   not asked for anything yet are cut, the oldest first; so they never stand in the way of one that has.
/// - Who has not asked within kPatience is cut, and so is an answer that takes too long.
class Seats {
 public:
  using SteadyTime = std::chrono::steady_clock::time_point;
  using Id = std::uint64_t;
  static constexpr std::chrono::seconds kPatience{5};
  static constexpr std::chrono::milliseconds kGrace{200};  ///< nobody is cut before
  static constexpr std::chrono::seconds kLongestAnswer{20};

  struct Limits {
    std::size_t seats = 64;
    std::size_t kept = 8;  ///< of these, for STOP and `control`
    std::size_t per_address = 40;
  };
  enum class Use {
    kNothing,  ///< has not asked for anything yet
    kRequest,
    kDownload,  ///< may take as long as it takes
    kStop,
    kControl,
    kWatch,  ///< the other WebSockets
  };

  explicit Seats(const Limits& limits) : limits_(limits) {}

  /// 0: the address has its share.
  Id open(const std::string& address, SteadyTime now);
  /// Whether there is a seat for what the connection turned out to be for.
  bool use(Id id, Use use, SteadyTime now);
  void close(Id id);

  /// Which connections are to be cut now. Each is named again until it is closed. `is_heard`: whether all
  /// that the connection has said was read.
  std::vector<Id> overdue(SteadyTime now, const std::function<bool(Id)>& is_heard) const;

  std::size_t taken() const { return guests_.size(); }
  std::uint64_t refused() const { return refused_; }

 private:
  struct Guest {
    std::string address;
    Use use = Use::kNothing;
    SteadyTime since;
  };
  std::size_t free(std::size_t taken) const { return limits_.seats - std::min(limits_.seats, taken); }

  Limits limits_;
  std::map<Id, Guest> guests_;  ///< the oldest first
  std::map<std::string, std::size_t> per_address_;
  std::size_t busy_ = 0;  ///< guests who have asked for something
  Id last_ = 0;
  std::uint64_t refused_ = 0;
};

}  // namespace dynslam
