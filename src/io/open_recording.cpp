// SPDX-License-Identifier: MIT
#include "io/open_recording.h"

#include <utility>

#include "base/error.h"
#include "io/carmen_log.h"
#include "io/mcap_recording.h"

namespace dynslam {
namespace {

bool begins_with(ByteSource& source, std::string_view magic) {
  std::string first(magic.size(), '\0');
  first.resize(source.read(first.data(), first.size()));
  source.seek(0);
  return first == magic;
}

}  // namespace

std::unique_ptr<Recording> open_recording(std::unique_ptr<ByteSource> source, const RecordingConfig& config) {
  const std::string name = source->name();
  if (source->size() == 0) throw InputError(name + ": is empty");
  const bool is_mcap = begins_with(*source, kMcapMagic);
  if (!source->fault().empty()) throw InputError(name + ": cannot be read: " + source->fault());
  if (is_mcap) return std::make_unique<McapRecording>(std::move(source), config);

  auto log = std::make_unique<CarmenLog>(std::move(source), config);
  if (!log->looks_right()) {
    const std::string fault = log->fault().empty() ? "" : " (" + log->fault() + ")";
    throw InputError(name + ": not a recording: neither MCAP nor a CARMEN log" + fault);
  }
  return log;
}

std::unique_ptr<Recording> open_recording(const std::string& path, const RecordingConfig& config) {
  return open_recording(std::make_unique<FileSource>(path), config);
}

}  // namespace dynslam
