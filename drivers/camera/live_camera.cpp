// SPDX-License-Identifier: MIT
#include "drivers/camera/live_camera.h"

#include <utility>

#include "device/device_error.h"

namespace dynslam {
namespace {

using std::chrono::seconds;
using std::chrono::steady_clock;

constexpr seconds kPause{1};
constexpr seconds kStalled{2};
/// Older than this, the camera's clock is not ours.
constexpr Duration kOldest = seconds(1);

}  // namespace

LiveCamera::LiveCamera(const CameraConfig& config, const Clock& clock, Open open,
                       Clock::SteadyTime::duration off_after)
    : config_(config),
      clock_(clock),
      open_(std::move(open)),
      off_after_(off_after),
      encoder_(config.jpeg_quality),
      rest_([this] { watch_for_rest(); }) {}

LiveCamera::~LiveCamera() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  rest_.join();
}

std::optional<JpegFrame> LiveCamera::next(Time until) {
  if (steady_clock::now() < ask_again_) throw DeviceError(trouble_);
  try {
    if (!copy_next(clock_.steady(until))) return std::nullopt;
  } catch (const DeviceError& e) {
    trouble_ = e.what();
    ask_again_ = steady_clock::now() + kPause;
    throw;
  }
  return JpegFrame{stamp_, encoder_.encode(picture_.view())};
}

bool LiveCamera::copy_next(SteadyTime until) {
  const std::lock_guard lock(mutex_);
  try {
    if (!source_) {
      source_ = open_(config_);
      last_picture_ = steady_clock::now();
    }
    const bool came = source_->next(until, [this](const RawFrame& frame) {
      const bool odd = frame.age < Duration(0) || frame.age > kOldest;
      stamp_ = clock_.now() - (odd ? Duration(0) : frame.age);
      picture_.copy(frame.picture, config_.rotation_deg == 180);
    });
    asked_ = steady_clock::now();
    if (came) last_picture_ = asked_;
    if (asked_ - last_picture_ > kStalled)
      throw DeviceError("camera: no picture for 2 s: is its ribbon cable firm at both ends?");
    changed_.notify_all();
    return came;
  } catch (const DeviceError&) {
    source_.reset();
    throw;
  }
}

void LiveCamera::watch_for_rest() {
  std::unique_lock lock(mutex_);
  while (!ending_) {
    if (!source_) {
      changed_.wait(lock);
    } else if (steady_clock::now() < asked_ + off_after_) {
      changed_.wait_until(lock, asked_ + off_after_);
    } else {
      source_.reset();
    }
  }
}

}  // namespace dynslam
