// SPDX-License-Identifier: MIT
#include "io/map_file.h"

#include <algorithm>
#include <cctype>

#include "base/number_text.h"

namespace dynslam {
namespace {

// map_server turns a pixel p into the probability (255 - p) / 255 and compares it with the thresholds below.
constexpr char kFreePixel = static_cast<char>(254);
constexpr char kUnknownPixel = static_cast<char>(205);
constexpr char kOccupiedPixel = 0;

char pixel_of(CellState state) {
  switch (state) {
    case CellState::kFree:
      return kFreePixel;
    case CellState::kOccupied:
      return kOccupiedPixel;
    case CellState::kUnknown:
      break;
  }
  return kUnknownPixel;
}

bool is_empty(const TrinaryMap& map) { return map.width <= 0 || map.height <= 0; }

std::string pgm_header(int width, int height) {
  return "P5\n" + std::to_string(width) + ' ' + std::to_string(height) + "\n255\n";
}

// Never with an exponent: YAML 1.1 readers take "1e-05" for a word.
std::string yaml_number(double value) {
  std::string text;
  append_fixed(text, value, 9);
  while (text.ends_with('0') && !text.ends_with(".0")) text.pop_back();
  return text == "-0.0" ? "0.0" : text;
}

std::string yaml_text(const std::string& text) {
  const auto is_plain = [](unsigned char c) { return std::isalnum(c) || c == '.' || c == '_' || c == '/'; };
  if (!text.empty() && std::all_of(text.begin(), text.end(), is_plain)) return text;
  std::string quoted = "'";
  for (const char c : text) quoted.append(c == '\'' ? 2 : 1, c);
  return quoted + "'";
}

}  // namespace

void write_pgm(const TrinaryMap& map, const ByteSink& out) {
  if (is_empty(map)) {
    out(pgm_header(1, 1) + kUnknownPixel);
    return;
  }
  out(pgm_header(map.width, map.height));
  std::string pixels(static_cast<std::size_t>(map.width), kUnknownPixel);
  for (int row = map.height - 1; row >= 0; --row) {
    for (int column = 0; column < map.width; ++column) {
      pixels[static_cast<std::size_t>(column)] = pixel_of(map.at(column, row));
    }
    out(pixels);
  }
}

std::string to_pgm(const TrinaryMap& map) {
  std::string bytes;
  bytes.reserve(map.cells.size() + 32);
  write_pgm(map, [&](std::string_view piece) { bytes += piece; });
  return bytes;
}

std::string to_map_yaml(const TrinaryMap& map, const std::string& image_name) {
  return "image: " + yaml_text(image_name) + "\nmode: trinary\nresolution: " + yaml_number(map.cell_size_m) +
         "\norigin: [" + yaml_number(map.origin.x * map.cell_size_m) + ", " +
         yaml_number(map.origin.y * map.cell_size_m) +
         ", 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
}

}  // namespace dynslam
