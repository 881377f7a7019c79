// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace dynslam {

/// A file of web/ that was put into the program when it was built, by its name without folders. Throws
/// std::logic_error when there is none.
std::string_view embedded_file(std::string_view name);

}  // namespace dynslam
