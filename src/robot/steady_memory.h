// SPDX-License-Identifier: MIT
#pragma once

namespace dynslam {

/// Lets the process give large blocks back to the system as soon as they are freed. Left alone, glibc learns
/// from the first large block freed to keep all such blocks in its heap, where small ones that stay longer
/// break it up: resident memory creeps up over a quarter of an hour though what is in use does not. Does
/// nothing with other C libraries. To be called before there are threads.
void keep_memory_steady();

}  // namespace dynslam
