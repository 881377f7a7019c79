// SPDX-License-Identifier: MIT
#include "io/mcap_file.h"

#include <stdexcept>
#include <utility>

namespace dynslam {

McapFile::McapFile(std::string path, std::uint64_t free_floor, const std::string& library,
                   const McapWriter::Metadata& about)
    : file_(std::move(path), free_floor),
      mcap_([this](std::string_view bytes) { file_.append(bytes); }),
      ros_(mcap_) {
  try {
    mcap_.begin(library, "dynslam", about);
  } catch (...) {
    file_.remove();  // without its head it is nothing
    throw;
  }
}

std::string McapFile::finish() {
  std::string trouble;
  file_.use_floor();
  try {
    mcap_.close_chunk();
  } catch (const std::runtime_error& e) {
    trouble = e.what();
    mcap_.drop_chunk();
  }
  try {
    mcap_.finish();
  } catch (const std::runtime_error& e) {
    if (trouble.empty()) trouble = e.what();
  }
  return trouble;
}

}  // namespace dynslam
