// SPDX-License-Identifier: MIT
#include "drive/scan_watch.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>

#include "drive/obstacle_points.h"
#include "drive/stamped.h"
#include "drive/words.h"

namespace dynslam {
namespace {

/// With fewer, chance or a hall without walls may repeat a scan.
constexpr std::size_t kReturnsThatTell = 20;
/// A lidar with a smaller share of valid beams is covered, or looks nowhere.
constexpr double kLeastValidShare = 0.05;
/// Somewhere in a building is a wall: one to which nothing at all comes back is covered, or broken.
constexpr double kLeastReturnShare = 0.01;

/// An infinite range is valid too: there is nothing.
bool is_valid(const Beam& b) {
  return std::isfinite(b.angle_rad) && (is_return(b) || std::isinf(b.range_m)) && b.range_m > 0.0F;
}

bool is_blind(const Scan& scan) {
  std::size_t valid = 0, returns = 0;
  for (const Beam& b : scan.beams) {
    valid += is_valid(b) ? 1 : 0;
    returns += is_valid(b) && is_return(b) ? 1 : 0;
  }
  const auto all = static_cast<double>(scan.beams.size());
  return returns == 0 || static_cast<double>(valid) < kLeastValidShare * all ||
         static_cast<double>(returns) < kLeastReturnShare * all || !is_finite(scan.mount.robot_T_lidar);
}

bool repeats(const Scan& a, const Scan& b) {
  if (a.beams.size() != b.beams.size()) return false;
  std::size_t returns = 0;
  for (std::size_t i = 0; i < a.beams.size(); ++i) {
    const float range_a = a.beams[i].range_m, range_b = b.beams[i].range_m;
    if (std::bit_cast<std::uint32_t>(range_a) != std::bit_cast<std::uint32_t>(range_b)) return false;
    returns += is_return(a.beams[i]) ? 1 : 0;
  }
  return returns >= kReturnsThatTell;
}

}  // namespace

ScanWatch::Trouble ScanWatch::take(Time now, const std::shared_ptr<const Scan>& scan) {
  if (end_of(*scan) > now + kStampJitter) return Trouble::kFuture;
  if (newest_ && scan->stamp <= newest_->stamp) return trouble_;
  const auto before = newest_;
  newest_ = scan;
  if (is_blind(*scan)) return Trouble::kBlind;
  if (before && repeats(*before, *scan)) return Trouble::kFrozen;
  good_ = scan;
  good_end_ = end_of(*scan);
  return Trouble::kNone;
}

Finding ScanWatch::update(Time now, const std::shared_ptr<const Scan>& newest) {
  if (newest && newest != newest_) trouble_ = take(now, newest);
  if (good_ && is_fresh(good_end_, now, timeout_)) return {};
  std::string words;
  switch (trouble_) {
    case Trouble::kNone:
      words = "no lidar data";
      break;
    case Trouble::kFuture:
      words = "the lidar's stamps are ahead of the clock";
      break;
    case Trouble::kBlind:
      words = "the lidar sees nothing valid";
      break;
    case Trouble::kFrozen:
      words = "the lidar repeats the same scan";
      break;
  }
  words += good_ ? " for " + seconds_text(now - good_end_) : std::string(" yet");
  return {Cause::kScan, {Motion::kStop, words}};
}

}  // namespace dynslam
