// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace dynslam {

/// The addresses that this machine has now, with the length of their network's prefix: "192.168.1.7/24". Asks
/// the system; those that others can reach it by come first, then loopback. Empty when the system does not
/// say.
std::vector<std::string> own_addresses();

/// The name that this machine has in the network; empty when it has none.
std::string own_host_name();

}  // namespace dynslam
