// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "base/config_field.h"

namespace dynslam {

/// Section [camera] of the configuration.
struct CameraConfig {
  std::string name = "auto";
  int width_px = 960;
  int height_px = 540;
  double rate_hz = 20.0;
  int jpeg_quality = 80;
  int rotation_deg = 0;
  int exposure_us = 0;
  double gain = 0.0;
  double brighter_ev = 0.0;

  bool has_camera() const { return name != "none"; }

  /// What is wrong with the values together, if anything.
  std::optional<std::string> problem() const {
    if (rotation_deg != 0 && rotation_deg != 180) return "camera.rotation_deg: not 0 or 180";
    if (width_px % 2 != 0 || height_px % 2 != 0) return "camera: width_px and height_px must be even";
    return std::nullopt;
  }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"name", "part of the camera's name, as in imx219; auto: the first there is; none: no camera"},
          self.name);
    visit(Field{"width_px", "width of the pictures", 64, 1920}, self.width_px);
    visit(Field{"height_px", "height of the pictures", 64, 1080}, self.height_px);
    visit(Field{"rate_hz", "pictures a second while somebody watches", 1.0, 60.0}, self.rate_hz);
    visit(Field{"jpeg_quality", "1 to 100; twice the bytes from 80 to 92", 1, 100}, self.jpeg_quality);
    visit(Field{"rotation_deg", "180 when the camera is mounted upside down", 0, 180}, self.rotation_deg);
    visit(Field{"exposure_us", "how long a picture is exposed; 0: as the light asks for", 0, 1000000},
          self.exposure_us);
    visit(Field{"gain", "of the sensor; 0: as the light asks for", 0.0, 64.0}, self.gain);
    visit(Field{"brighter_ev", "brighter or darker than the camera would have it", -4.0, 4.0},
          self.brighter_ev);
  }
};

}  // namespace dynslam
