// SPDX-License-Identifier: MIT
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "io/ros_writer.h"
#include "server/access/credential_book.h"
#include "tests/drivers/rplidar_encoder.h"
#include "tests/io/mcap_builder.h"

namespace dynslam::test {
namespace {

void write(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

std::string mcap(const McapBuilder::Options& options) {
  McapBuilder file(options);
  const auto scan = file.add_channel("/scan", "sensor_msgs/msg/LaserScan");
  const auto heading = file.add_channel("/imu", "sensor_msgs/msg/Imu");
  const auto wheels = file.add_channel("/odom", "nav_msgs/msg/Odometry");
  const auto tf = file.add_channel("/tf_static", "tf2_msgs/msg/TFMessage");
  file.add_message(tf, 1, transforms({{"base_link", "laser", 0.1, 0.0, 0.2, {1.0, 0.0, 0.0, 0.0}}}));
  file.add_message(scan, 1, laser_scan({}));
  file.add_message(heading, 1, imu(1, {}));
  file.add_message(wheels, 1, odometry(1, 2.0, 3.0, {}));
  return file.finish().substr(McapBuilder::magic().size());
}

void write_access(const std::string& folder) {
  const std::string secret(43, 'A');
  write(folder + "/http_headers/browser",
        "192.168.1.5\nPOST\n\nrobot.local:8080\nhttp://robot.local:8080\ntheme=dark; dynslam_session=" +
            secret + "\n");
  write(folder + "/http_headers/program",
        "::ffff:10.0.0.1\nGET\nupgrade\n[fd00::1]:80\n\n\nBearer " + secret);
  write(folder + "/http_headers/stranger", "fe80::1%wlan0\nPUT\n\nABCD-0123\nhttps://8.8.8.8\n10.0.0.0/8\n");
  CredentialBook book{std::chrono::days(90)};
  const std::chrono::sys_seconds day(std::chrono::days(20000));
  book.add({"a", Credential::Kind::kSession, "phone", Role::kAdmin, digest_of("a"), day, day});
  book.add({"b", Credential::Kind::kToken, "J\xc3\xbcrgen", Role::kViewer, digest_of("b"), day, day});
  write(folder + "/access_file/two", book.to_json());
}

/// As a robot of ours records.
std::string recorded() {
  std::string bytes;
  McapWriter mcap([&](std::string_view more) { bytes += more; });
  mcap.begin("dynslam", "dynslam", {{"config", "{}"}});
  RosWriter ros(mcap);
  const Time t(std::chrono::milliseconds(100));
  Scan scan{t, {}, {{0.1, 0.0, 0.2}, true, 0.2}};
  for (const float angle : {0.0F, 0.1F, 0.25F, 0.3F}) scan.beams.push_back({angle, 2.0F, angle});
  ros.write(t, scan);
  ros.write(t, ImuSample{t});
  mcap.close_chunk();
  ros.write(t, PoseFix{});
  mcap.close_chunk();
  mcap.finish();
  return bytes.substr(kMcapMagic.size());
}

/// What the chips of drivers/ say, byte by byte.
void write_drivers(const std::string& folder) {
  write(folder + "/bno055/burst", std::string("\0\0\0\0\xa0\5\xe0\x10\0\0\0\0\x41\x2d\0\0\0\0\x41\x2d", 20));
  write(folder + "/bno055/status", std::string("\x1b\xf8\x0f\0\0\5\0\0\0\x8", 10));
  write(folder + "/bno055/profile", "bno055 1 00000000000000000000000000000000000000000000 290628dd\n");
  write(folder + "/thunderborg/battery", std::string("\x15\1\x54\0\0\0", 6));
  write(folder + "/thunderborg/motor", std::string("\xa\2\x80\0\0\0", 6));
}

/// A few packets of a kind, behind the byte that says which.
void write_rplidar(const std::string& folder) {
  const std::vector<double> mm(97, 2000.0), angle_deg(96, 30.0), back_deg(32, 7.0);
  const auto put = [&](const char* name, char kind, const auto& packet_at) {
    std::string bytes(1, kind);
    for (int i = 0; i < 4; ++i) {
      const PacketBytes packet = packet_at(340.0 + 10.0 * i);
      bytes.append(packet.begin(), packet.end());
    }
    write(folder + "/rplidar/" + name, bytes);
  };
  put("standard", 0, [&](double deg) {
    PacketBytes all;
    for (int i = 0; i < 4; ++i) {
      const PacketBytes node = encode_standard(i == 2, deg / 2, 1234.25);
      all.insert(all.end(), node.begin(), node.end());
    }
    return all;
  });
  put("express", 1, [&](double deg) { return encode_express(deg, false, mm, back_deg); });
  put("hq", 2, [&](double) { return encode_hq(angle_deg, mm, 5); });
  put("ultra", 3, [&](double deg) { return encode_ultra(deg, false, mm); });
  put("dense", 4, [&](double deg) { return encode_dense(deg, false, mm); });
  put("ultra_dense", 5, [&](double deg) { return encode_ultra_dense(deg, false, mm); });
}

void write_all(const std::string& folder) {
  write_rplidar(folder);
  write_access(folder);
  write_drivers(folder);
  write(folder + "/mcap/flat", mcap({std::nullopt, 2, true, false}));
  write(folder + "/mcap/plain", mcap({"", 2, false, false}));
  write(folder + "/mcap/zstd", mcap({"zstd", 2, false, true}));
  write(folder + "/mcap/lz4", mcap({"lz4", 2, true, false}));
  write(folder + "/mcap/recorded", recorded());
  const std::string flaser = "FLASER 3 1.25 2.5 81.91 1 2 3 4 5 0.5 12.25 host 0.1\n";
  write(folder + "/carmen/flaser",
        "PARAM robot_front_laser_max 50 0 h 0\nPARAM laser_front_laser_fov 180 0 h 0\n" + flaser +
            "ODOM 1 2 3 0 0 0 4 h 1\n" + flaser);
  write(folder + "/carmen/robotlaser",
        "ROBOTLASER1 0 -0.5 1.0 0.5 30 0.01 0 3 2 3 nan 1 77 1 3 1.5 1 2 1.5 0.1 0.2 0.3 0.4 0.5 99.5 host "
        "1.0\n");
}

}  // namespace
}  // namespace dynslam::test

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: make_corpus FOLDER\n";
    return 2;
  }
  dynslam::test::write_all(argv[1]);
}
