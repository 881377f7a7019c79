// SPDX-License-Identifier: MIT
#include "drivers/camera/yuv_picture.h"

#include <algorithm>

namespace dynslam {

void YuvPicture::copy(const YuvView& from, bool upside_down) {
  view_ = from;
  std::array<std::size_t, 4> begin{};  // of each plane, and the end
  for (std::size_t p = 0; p < 3; ++p)
    begin[p + 1] = begin[p] + static_cast<std::size_t>(from.width_of(p)) * from.height_of(p);
  bytes_.resize(begin[3]);
  for (std::size_t p = 0; p < 3; ++p) {
    const auto width = static_cast<std::size_t>(from.width_of(p));
    const auto height = static_cast<std::size_t>(from.height_of(p));
    std::uint8_t* const plane = bytes_.data() + begin[p];
    view_.planes[p] = {plane, width};
    for (std::size_t y = 0; y < height; ++y) {
      const std::uint8_t* const row = from.planes[p].bytes + y * from.planes[p].stride;
      if (upside_down) {
        std::reverse_copy(row, row + width, plane + (height - 1 - y) * width);
      } else {
        std::copy_n(row, width, plane + y * width);
      }
    }
  }
}

}  // namespace dynslam
