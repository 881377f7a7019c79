// SPDX-License-Identifier: MIT
// The layer over libcamera, as thin as it goes: nothing in it can be tested without a camera.
#include <algorithm>
#include <cerrno>
#include <condition_variable>
#include <cstdint>
#include <ctime>
#include <map>
#include <mutex>
#include <system_error>
#include <utility>

#include <libcamera/libcamera.h>
#include <sys/mman.h>

#include "device/device_error.h"
#include "drivers/camera/frame_source.h"

namespace dynslam {
namespace {

namespace lc = libcamera;

constexpr unsigned kBuffers = 4;

DeviceError error_of(const std::string& what, int negative) {
  return DeviceError("camera: " + what + ": " + std::generic_category().message(-negative));
}

/// One a process. It stays once it runs: it notices by itself when cameras come and go.
lc::CameraManager& manager() {
  static std::mutex mutex;
  static std::unique_ptr<lc::CameraManager> running;
  const std::lock_guard lock(mutex);
  if (!running) {
    auto fresh = std::make_unique<lc::CameraManager>();
    if (const int failed = fresh->start(); failed < 0) throw error_of("libcamera does not start", failed);
    running = std::move(fresh);
  }
  return *running;
}

CameraInfo info_of(const lc::Camera& camera) {
  const auto model = camera.properties().get(lc::properties::Model);
  return {camera.id(), model ? std::string(*model) : std::string()};
}

std::shared_ptr<lc::Camera> find_camera(const std::string& name) {
  const auto cameras = manager().cameras();
  for (const auto& camera : cameras) {
    const CameraInfo info = info_of(*camera);
    if (name == "auto" || info.id.find(name) != std::string::npos ||
        info.model.find(name) != std::string::npos)
      return camera;
  }
  if (cameras.empty())
    throw DeviceError(
        "camera: libcamera finds none: is the ribbon cable in, camera_auto_detect=1 in config.txt, and the "
        "user in group video?");
  throw DeviceError("camera: none is called '" + name + "'; there is " + info_of(*cameras.front()).id);
}

/// Memory of the camera, for reading. It may be slow to read.
class Mapping {
 public:
  Mapping(int fd, std::size_t length) : length_(length) {
    void* const begin = mmap(nullptr, length, PROT_READ, MAP_SHARED, fd, 0);
    if (begin == MAP_FAILED) throw error_of("its memory cannot be mapped", -errno);
    begin_ = begin;
  }
  ~Mapping() { munmap(begin_, length_); }
  Mapping(const Mapping&) = delete;
  Mapping& operator=(const Mapping&) = delete;
  const std::uint8_t* at(std::size_t offset) const {
    return static_cast<const std::uint8_t*>(begin_) + offset;
  }

 private:
  void* begin_ = nullptr;
  std::size_t length_;
};

/// The sensor's stamps count from the start of the computer, suspended time included.
Duration age_of(lc::Request& request) {
  const auto taken = request.metadata().get(lc::controls::SensorTimestamp);
  if (!taken) return Duration(0);
  timespec now{};
  clock_gettime(CLOCK_BOOTTIME, &now);
  return std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec - *taken);
}

class LibcameraSource : public FrameSource {
 public:
  ~LibcameraSource() override;
  /// Throws DeviceError; then nothing is left but to destroy this.
  void begin(const CameraConfig& config);
  bool next(Clock::SteadyTime until, const Take& take) override;

 private:
  void configure(const CameraConfig& config);
  void map_buffers();
  void start(const CameraConfig& config);
  void map(const lc::FrameBuffer& buffer);
  void on_complete(lc::Request* request);
  void on_disconnect();
  void queue_again(lc::Request* request);

  std::shared_ptr<lc::Camera> camera_;
  bool acquired_ = false, started_ = false;
  std::unique_ptr<lc::CameraConfiguration> configuration_;
  lc::Stream* stream_ = nullptr;
  std::unique_ptr<lc::FrameBufferAllocator> allocator_;
  std::map<int, Mapping> memory_;                       ///< by descriptor
  std::map<const lc::FrameBuffer*, YuvView> pictures_;  ///< what each buffer holds
  std::vector<std::unique_ptr<lc::Request>> requests_;

  std::mutex mutex_;  ///< for what follows, which libcamera's thread touches too
  std::condition_variable changed_;
  lc::Request* newest_ = nullptr;
  bool gone_ = false;
};

LibcameraSource::~LibcameraSource() {
  if (started_) camera_->stop();
  if (camera_) {
    camera_->requestCompleted.disconnect(this);
    camera_->disconnected.disconnect(this);
  }
  requests_.clear();
  memory_.clear();
  allocator_.reset();
  if (acquired_) camera_->release();
}

void LibcameraSource::begin(const CameraConfig& config) {
  camera_ = find_camera(config.name);
  const int failed = camera_->acquire();
  if (failed == -EBUSY) throw DeviceError("camera: another program uses it");
  if (failed < 0) throw error_of("it cannot be had", failed);
  acquired_ = true;
  configure(config);
  map_buffers();
  start(config);
}

void LibcameraSource::configure(const CameraConfig& config) {
  configuration_ = camera_->generateConfiguration({lc::StreamRole::VideoRecording});
  if (!configuration_ || configuration_->empty()) throw DeviceError("camera: it gives no video");
  lc::StreamConfiguration& stream = configuration_->at(0);
  stream.size = {static_cast<unsigned>(config.width_px), static_cast<unsigned>(config.height_px)};
  stream.pixelFormat = lc::formats::YUV420;
  stream.bufferCount = kBuffers;
  stream.colorSpace = lc::ColorSpace::Sycc;  // as JPEG has it; video's own would come out pale
  if (configuration_->validate() == lc::CameraConfiguration::Invalid ||
      stream.pixelFormat != lc::formats::YUV420)
    throw DeviceError("camera: it gives no YUV420 pictures of this size, but " + stream.toString());
  if (const int failed = camera_->configure(configuration_.get()); failed < 0)
    throw error_of("it does not take its settings; does another program use it?", failed);
  stream_ = stream.stream();
}

void LibcameraSource::map_buffers() {
  allocator_ = std::make_unique<lc::FrameBufferAllocator>(camera_);
  if (const int failed = allocator_->allocate(stream_); failed < 0)
    throw error_of("there is no memory for its pictures; is the user in group video?", failed);
  for (const auto& buffer : allocator_->buffers(stream_)) {
    map(*buffer);
    auto request = camera_->createRequest();
    if (!request) throw DeviceError("camera: it takes no requests");
    if (const int failed = request->addBuffer(stream_, buffer.get()); failed < 0)
      throw error_of("it does not take its buffers", failed);
    requests_.push_back(std::move(request));
  }
}

/// Planes usually share a descriptor and differ in offset; where there is one plane only, they follow each
/// other in it.
void LibcameraSource::map(const lc::FrameBuffer& buffer) {
  const lc::StreamConfiguration& stream = configuration_->at(0);
  YuvView picture{static_cast<int>(stream.size.width & ~1U), static_cast<int>(stream.size.height & ~1U), {}};
  std::size_t offset = buffer.planes().front().offset;
  for (std::size_t p = 0; p < 3; ++p) {
    const auto& plane = buffer.planes()[buffer.planes().size() < 3 ? 0 : p];
    const std::size_t stride = p == 0 ? stream.stride : stream.stride / 2;
    if (buffer.planes().size() >= 3) offset = plane.offset;
    auto memory = memory_.find(plane.fd.get());
    if (memory == memory_.end()) {
      std::size_t length = 0;
      for (const auto& other : buffer.planes()) {
        if (other.fd.get() == plane.fd.get())
          length = std::max<std::size_t>(length, other.offset + other.length);
      }
      memory = memory_.try_emplace(plane.fd.get(), plane.fd.get(), length).first;
    }
    picture.planes[p] = {memory->second.at(offset), stride};
    offset += stride * static_cast<std::size_t>(picture.height_of(p));
  }
  pictures_.emplace(&buffer, picture);
}

void LibcameraSource::start(const CameraConfig& config) {
  lc::ControlList controls(camera_->controls());
  const auto has = [this](const lc::ControlId& id) {
    return camera_->controls().find(&id) != camera_->controls().end();
  };
  const auto each_us = static_cast<std::int64_t>(1e6 / config.rate_hz);
  const std::int64_t limits_us[2] = {each_us, each_us};
  if (has(lc::controls::FrameDurationLimits))
    controls.set(lc::controls::FrameDurationLimits, lc::Span<const std::int64_t, 2>(limits_us));
  if (config.exposure_us > 0 && has(lc::controls::ExposureTime))
    controls.set(lc::controls::ExposureTime, config.exposure_us);
  if (config.gain > 0.0 && has(lc::controls::AnalogueGain))
    controls.set(lc::controls::AnalogueGain, static_cast<float>(config.gain));
  if (config.brighter_ev != 0.0 && has(lc::controls::ExposureValue))
    controls.set(lc::controls::ExposureValue, static_cast<float>(config.brighter_ev));

  camera_->requestCompleted.connect(this, &LibcameraSource::on_complete);
  camera_->disconnected.connect(this, &LibcameraSource::on_disconnect);
  if (const int failed = camera_->start(&controls); failed < 0)
    throw error_of("it does not start; is another program or a killed one still at it?", failed);
  started_ = true;
  for (const auto& request : requests_) {
    if (const int failed = camera_->queueRequest(request.get()); failed < 0)
      throw error_of("it takes no requests", failed);
  }
}

bool LibcameraSource::next(Clock::SteadyTime until, const Take& take) {
  lc::Request* request = nullptr;
  {
    std::unique_lock lock(mutex_);
    changed_.wait_until(lock, until, [this] { return newest_ || gone_; });
    if (gone_) throw DeviceError("camera: it was unplugged");
    request = std::exchange(newest_, nullptr);
  }
  if (!request) return false;
  take({pictures_.at(request->findBuffer(stream_)), age_of(*request)});
  queue_again(request);
  return true;
}

/// In libcamera's own thread, which must not wait.
void LibcameraSource::on_complete(lc::Request* request) {
  if (request->status() == lc::Request::RequestCancelled) return;
  const lc::FrameBuffer* const buffer = request->findBuffer(stream_);
  const bool good = buffer && buffer->metadata().status == lc::FrameMetadata::FrameSuccess;
  lc::Request* spare = request;
  if (good) {
    const std::lock_guard lock(mutex_);
    spare = std::exchange(newest_, request);
  }
  if (spare) queue_again(spare);
  changed_.notify_one();
}

void LibcameraSource::on_disconnect() {
  {
    const std::lock_guard lock(mutex_);
    gone_ = true;
  }
  changed_.notify_one();
}

/// Refused, it is missing from then on; when all are, no picture comes and the camera is opened anew.
void LibcameraSource::queue_again(lc::Request* request) {
  request->reuse(lc::Request::ReuseBuffers);
  camera_->queueRequest(request);
}

}  // namespace

// What camera_module.cpp looks for; it takes what is thrown, too.
extern "C" {

void dynslam_list_cameras(std::vector<CameraInfo>& all) {
  for (const auto& camera : manager().cameras()) all.push_back(info_of(*camera));
}

void dynslam_open_camera(const CameraConfig& config, std::unique_ptr<FrameSource>& opened) {
  auto source = std::make_unique<LibcameraSource>();
  source->begin(config);
  opened = std::move(source);
}
}

}  // namespace dynslam
