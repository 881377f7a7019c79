// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string_view>

namespace dynslam {

struct EmbeddedFile {
  std::string_view name;  ///< without folders
  std::string_view bytes;
};

/// A file of web/ that was put into the program when it was built. Throws std::logic_error when there is none
/// of that name.
std::string_view embedded_file(std::string_view name);

/// The files that the page is made of, each gzipped; none where it was built without.
std::span<const EmbeddedFile> embedded_page();

}  // namespace dynslam
