// SPDX-License-Identifier: MIT
#include "supervisor.h"

#include <cstdint>

#ifdef DYNSLAM_HAS_SYSTEMD
#include <systemd/sd-daemon.h>
#endif

namespace dynslam {
namespace {

void tell([[maybe_unused]] const char* what) {
#ifdef DYNSLAM_HAS_SYSTEMD
  sd_notify(0, what);
#endif
}

}  // namespace

Supervisor::Supervisor() {
#ifdef DYNSLAM_HAS_SYSTEMD
  std::uint64_t microseconds = 0;
  // Twice as often as is asked for: one may come late.
  if (sd_watchdog_enabled(0, &microseconds) > 0) every_ = std::chrono::microseconds(microseconds / 2);
#endif
}

void Supervisor::ready() { tell("READY=1"); }

void Supervisor::alive() {
  const auto now = std::chrono::steady_clock::now();
  if (every_.count() == 0 || now - told_ < every_ / 2) return;
  told_ = now;
  tell("WATCHDOG=1");
}

void Supervisor::stopping() { tell("STOPPING=1"); }

}  // namespace dynslam
