// SPDX-License-Identifier: MIT
#pragma once

#include <pthread.h>
#include <sched.h>

namespace dynslam::test {

/// For a thread that stands for a kernel's driver, or for a device: what this computer is busy with does not
/// hold these up, so the thread comes before all of a program's, where this user may have real-time threads
/// at all. Any thread, of itself; as often as it likes.
inline void be_no_part_of_the_program() {
  static thread_local const bool done = [] {
    const sched_param above{sched_get_priority_max(SCHED_FIFO)};
    return pthread_setschedparam(pthread_self(), SCHED_FIFO, &above) == 0;
  }();
  static_cast<void>(done);
}

}  // namespace dynslam::test
