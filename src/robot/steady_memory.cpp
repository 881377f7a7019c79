// SPDX-License-Identifier: MIT
#include "robot/steady_memory.h"

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace dynslam {

void keep_memory_steady() {
#ifdef __GLIBC__
  // Blocks of this size come several to a finished local map, not to a scan: asking for them anew is cheap.
  mallopt(M_MMAP_THRESHOLD, 256 * 1024);
  mallopt(M_TRIM_THRESHOLD, 256 * 1024);
#endif
}

}  // namespace dynslam
