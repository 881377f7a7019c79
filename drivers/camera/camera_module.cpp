// SPDX-License-Identifier: MIT
// Loads what is linked with libcamera, see libcamera_source.cpp: a program that never asks for a camera does
// not pay for it.
#include <filesystem>
#include <mutex>
#include <string>
#include <system_error>

#include <dlfcn.h>

#include "device/device_error.h"
#include "drivers/camera/frame_source.h"

namespace dynslam {
namespace {

/// It stays once it is there. Throws DeviceError.
void* camera_module() {
  static std::mutex mutex;
  static void* loaded = nullptr;
  const std::lock_guard lock(mutex);
  if (loaded) return loaded;
  // Beside the program as it is installed, and as programs lie where they were built.
  std::error_code none;
  const std::filesystem::path here = std::filesystem::read_symlink("/proc/self/exe", none).parent_path();
  std::string why;
  for (const char* folder : {"../lib/dynslam", "../../lib/dynslam"}) {
    const std::filesystem::path file = here / folder / "camera.so";
    if (!std::filesystem::exists(file, none)) continue;
    loaded = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (loaded) return loaded;
    why = ::dlerror();
  }
  throw DeviceError("camera: " + (why.empty() ? "lib/dynslam/camera.so is missing: install it again" : why));
}

template <class Function>
Function* function(const char* name) {
  void* found = ::dlsym(camera_module(), name);
  if (!found) throw DeviceError("camera: lib/dynslam/camera.so is of another version: install it again");
  return reinterpret_cast<Function*>(found);
}

}  // namespace

std::vector<CameraInfo> list_cameras() {
  std::vector<CameraInfo> all;
  function<void(std::vector<CameraInfo>&)>("dynslam_list_cameras")(all);
  return all;
}

std::unique_ptr<FrameSource> open_libcamera(const CameraConfig& config) {
  std::unique_ptr<FrameSource> source;
  function<void(const CameraConfig&, std::unique_ptr<FrameSource>&)>("dynslam_open_camera")(config, source);
  return source;
}

}  // namespace dynslam
