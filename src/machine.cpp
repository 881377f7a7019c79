// SPDX-License-Identifier: MIT
#include "machine.h"

#include <charconv>
#include <fstream>
#include <thread>

#include <sys/utsname.h>

#include "drivers/pi/pi_watch.h"

namespace dynslam {
namespace {

namespace fs = std::filesystem;

/// The first line; empty where there is none.
std::string line_of(const fs::path& path) {
  std::ifstream in(path);
  std::string line;
  std::getline(in, line);
  return line;
}

/// What a file of "name: value" lines says first of a name.
std::string value_in(const fs::path& path, const std::string& name) {
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    const auto colon = line.find(':');
    if (!line.starts_with(name) || colon == std::string::npos) continue;
    const auto begin = line.find_first_not_of(" \t", colon + 1);
    return begin == std::string::npos ? "" : line.substr(begin);
  }
  return {};
}

/// The number that a text begins with; 0 for none.
int number_of(const std::string& text) {
  int number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

std::string architecture() {
  utsname name{};
  return uname(&name) == 0 ? name.machine : "";
}

}  // namespace

Machine this_machine(const fs::path& root) {
  const PiWatch watch(root);
  const PiState state = watch.read();
  const fs::path speed = root / "sys/devices/system/cpu/cpu0/cpufreq";
  Machine machine;
  machine.model = watch.model();
  if (machine.model.empty()) machine.model = value_in(root / "proc/cpuinfo", "model name");
  machine.architecture = architecture();
  machine.governor = line_of(speed / "scaling_governor");
  machine.cores = std::thread::hardware_concurrency();
  machine.most_mhz = number_of(line_of(speed / "cpuinfo_max_freq")) / 1000;
  machine.memory_mib = number_of(value_in(root / "proc/meminfo", "MemTotal")) / 1024;
  machine.temperature_c = state.temperature_c;
  if (state.flags) machine.throttled = state.flags->bits();
  machine.advice = state.advice();
  return machine;
}

}  // namespace dynslam
