// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>

#include <png.h>

#include "io/picture_band.h"

namespace dynslam {

/// Packs a picture into a PNG row by row. The same rows give the same bytes: no time, no text, no settings
/// from outside.
class PngWriter {
 public:
  /// Throws std::runtime_error for a size that PNG does not allow (below 1, above a million).
  PngWriter(int width, int height);
  ~PngWriter();
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;

  /// The next row from the top; as many pixels as the picture is wide.
  void write_row(std::span<const Rgb> row);

  /// The file, once all rows are written. Throws std::runtime_error when rows are missing.
  std::string finish();

 private:
  void write_header(int width, int height);
  [[noreturn]] void fail() const;

  std::string bytes_;
  std::string error_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

}  // namespace dynslam
