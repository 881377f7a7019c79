// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "device/camera.h"
#include "drivers/camera/frame_source.h"
#include "drivers/camera/jpeg_encoder.h"

namespace dynslam {

/// The robot's camera. It is switched on when it is asked for a picture first, and off when nobody asked for
/// one for some seconds. The picture is compressed in the thread that asks, and only the newest; what comes
/// meanwhile is dropped. What fails is opened anew a second later, at the next call.
class LiveCamera : public Camera {
 public:
  using Open = std::function<std::unique_ptr<FrameSource>(const CameraConfig&)>;

  /// REQUIRES: no problem() in `config`. `clock` must outlive this and run like life.
  LiveCamera(const CameraConfig& config, const Clock& clock, Open open = open_libcamera,
             Clock::SteadyTime::duration off_after = std::chrono::seconds(3));
  ~LiveCamera() override;
  LiveCamera(const LiveCamera&) = delete;
  LiveCamera& operator=(const LiveCamera&) = delete;

  std::optional<JpegFrame> next(Time until) override;

 private:
  using SteadyTime = Clock::SteadyTime;

  bool copy_next(SteadyTime until);
  void watch_for_rest();

  const CameraConfig config_;
  const Clock& clock_;
  const Open open_;
  const SteadyTime::duration off_after_;

  // Of the thread that asks.
  JpegEncoder encoder_;
  YuvPicture picture_;
  Time stamp_;  ///< of `picture_`
  std::string trouble_;
  SteadyTime ask_again_, last_picture_;

  std::mutex mutex_;  ///< for what follows; held while a picture is waited for
  std::condition_variable changed_;
  std::unique_ptr<FrameSource> source_;  ///< null: off
  SteadyTime asked_;                     ///< last
  bool ending_ = false;
  std::thread rest_;  ///< switches off
};

}  // namespace dynslam
