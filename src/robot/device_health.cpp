// SPDX-License-Identifier: MIT
#include "robot/device_health.h"

namespace dynslam {
namespace {

constexpr Duration kShownEvery = std::chrono::milliseconds(100);
constexpr Duration kAskedEvery = std::chrono::seconds(1);

/// Also when the clock was set back.
bool is_due(Time last, Duration period, Time now) { return now < last || now >= last + period; }

}  // namespace

HealthKeeper::HealthKeeper(const Device* device, Latest<DeviceHealth>& shown)
    : device_(device), shown_(shown) {
  if (!device) return;
  health_.present = true;
  shown_.put(health_);
}

void HealthKeeper::answered(Time stamp) {
  const bool is_news = health_.samples == 0 || !health_.trouble.empty();
  ++health_.samples;
  health_.last_sample = stamp;
  health_.trouble.clear();
  if (!is_news && !is_due(shown_at_, kShownEvery, stamp)) return;
  shown_at_ = stamp;
  if (is_news || is_due(asked_at_, kAskedEvery, stamp)) {
    asked_at_ = stamp;
    ask_device();
  }
  shown_.put(health_);
}

void HealthKeeper::failed(const std::string& trouble) {
  ++health_.errors;
  health_.trouble = trouble;
  ask_device();
  shown_.put(health_);
}

void HealthKeeper::ask_device() {
  health_.about = device_->about();
  health_.counters = device_->counters();
}

}  // namespace dynslam
