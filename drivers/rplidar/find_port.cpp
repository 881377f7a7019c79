// SPDX-License-Identifier: MIT
#include "drivers/rplidar/find_port.h"

#include <algorithm>
#include <filesystem>

namespace dynslam::rplidar {

std::vector<std::string> find_ports(const std::string& folder) {
  namespace fs = std::filesystem;
  std::vector<std::string> all, adapters;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename();
    all.push_back(it->path());
    if (name.find("CP210") != std::string::npos) adapters.push_back(it->path());
  }
  if (adapters.empty() && all.size() == 1) return all;
  std::sort(adapters.begin(), adapters.end());
  return adapters;
}

}  // namespace dynslam::rplidar
