// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>
#include <vector>

#include "io/picture_band.h"

namespace dynslam {

/// Room that a text of this height takes to the right, in pixels, without the width of its lines.
float text_width(std::string_view text, float height_px);

/// A text as lines, top left corner at (x, y). It knows what a scale bar says: digits, '.', 'm', 'k' and the
/// space; other characters leave a gap.
std::vector<Stroke> text_strokes(std::string_view text, float x, float y, float height_px, Rgb colour);

}  // namespace dynslam
