// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "drivers/rplidar/bytes.h"
#include "drivers/rplidar/messages.h"

/// The packets that carry measurements. Angles are the device's: degrees, clockwise seen from above.
namespace dynslam::rplidar {

/// How packets of one kind look.
struct PacketForm {
  AnswerType type{};
  std::size_t size = 0;     ///< bytes
  std::size_t samples = 0;  ///< beams in each
  bool is_capsule =
      false;  ///< of beams at even steps up to where the next packet begins; else each says its angle
  std::size_t witnesses = 0;  ///< packets behind it that must begin as they should, as it has no checksum
};
/// Null for a kind that is not known.
const PacketForm* find_form(AnswerType type);

inline constexpr std::size_t kPacketHead = 2;  ///< bytes that begins_packet looks at
inline constexpr std::size_t kLargestPacket = 781, kMostSamples = 96;

/// Whether a packet may begin here. REQUIRES: kPacketHead bytes.
bool begins_packet(const PacketForm& form, ByteView bytes);
/// Whether its checksum says that it came whole. REQUIRES: form.size bytes.
bool is_intact(const PacketForm& form, ByteView packet);

/// A beam of a capsule.
struct CapsuleBeam {
  float range_mm = 0.0F;  ///< 0: nothing came back
  float back_deg = 0.0F;  ///< how far its angle lies behind the even step, as it depends on the range
};
using CapsuleBeams = std::array<CapsuleBeam, kMostSamples>;

/// The angle at which a capsule's first beam was taken, before correction, 0 to 360.
float start_deg(const PacketForm& form, ByteView packet);
/// Whether the capsule is the first since the lidar began to measure or lost its angle.
bool begins_anew(const PacketForm& form, ByteView packet);
/// REQUIRES: intact capsules of this form, one after the other.
void decode_capsule(const PacketForm& form, ByteView packet, ByteView next, CapsuleBeams& beams);

/// A beam that says its angle.
struct Node {
  float angle_deg = 0.0F;  ///< 0 to 360
  float range_mm = 0.0F;   ///< 0: nothing came back
  bool first = false;      ///< of a turn
};
using Nodes = std::array<Node, kMostSamples>;

/// REQUIRES: an intact packet of a form that is no capsule.
void decode_nodes(const PacketForm& form, ByteView packet, Nodes& nodes);

}  // namespace dynslam::rplidar
