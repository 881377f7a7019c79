// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

/// What an RPLIDAR does on its side of the line, written after the protocol alone. Millimetres, 0 for no
/// return; degrees clockwise.
namespace dynslam::test {

using PacketBytes = std::vector<std::uint8_t>;

PacketBytes encode_standard(bool first, double angle_deg, double mm);
/// 32 beams; each lies `back_deg` behind its even step: 0 to 7.875.
PacketBytes encode_express(double start_deg, bool anew, std::span<const double> mm,
                           std::span<const double> back_deg);
/// 96 beams, and the first of the next capsule.
PacketBytes encode_ultra(double start_deg, bool anew, std::span<const double> mm);
/// 40 beams.
PacketBytes encode_dense(double start_deg, bool anew, std::span<const double> mm);
/// 64 beams.
PacketBytes encode_ultra_dense(double start_deg, bool anew, std::span<const double> mm);
/// 96 beams; the first of a turn is the one at `first`, if it is less.
PacketBytes encode_hq(std::span<const double> angle_deg, std::span<const double> mm, std::size_t first);

/// How far a beam of a triangulating lidar lies behind its even step.
double triangulation_deg(double mm);

}  // namespace dynslam::test
