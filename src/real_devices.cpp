// SPDX-License-Identifier: MIT
#include "real_devices.h"

#include <utility>

#include <spdlog/spdlog.h>

#include "drivers/rplidar/rplidar.h"
#include "io/state_file.h"
#ifdef DYNSLAM_HAS_BNO055
#include "drivers/bno055/bno055.h"
#endif
#ifdef DYNSLAM_HAS_THUNDERBORG
#include "drivers/thunderborg/thunderborg.h"
#endif
#ifdef DYNSLAM_HAS_CAMERA
#include "drivers/camera/live_camera.h"
#endif
#ifdef DYNSLAM_HAS_GPIO
#include "drivers/gpio/gpio_pins.h"
#include "drivers/gpio/output_pin.h"
#include "drivers/gpio/wheel_encoders.h"
#endif

namespace dynslam {
namespace {

[[noreturn]] [[maybe_unused]] void not_built_in(const std::string& device) {
  throw DeviceError(device + ": this program was built without its driver");
}

// These take the place of devices that the configuration names and whose driver is not there: a robot must
// not drive as if it had no e-stop.
class NoMotors : public Motors {
 public:
  void drive(const WheelPower&) override { not_built_in("motors"); }
  MotorState read() override { not_built_in("motors"); }
};
class NoImu : public Imu {
 public:
  std::optional<ImuSample> next(Time) override { not_built_in("imu"); }
};
class NoCamera : public Camera {
 public:
  std::optional<JpegFrame> next(Time) override { not_built_in("camera"); }
};
class NoPins : public Pins {
 public:
  PinState read() override { not_built_in("pins"); }
};

class NoWheels : public Wheels {
 public:
  std::optional<OdometrySample> next(Time) override { not_built_in("wheels"); }
};

[[maybe_unused]] constexpr const char* kProfileFile = "bno055-calibration";

#ifdef DYNSLAM_HAS_BNO055
ProfileStore profile_store(const std::string& folder) {
  if (folder.empty()) return {};
  const auto file = std::make_shared<StateFile>(folder + "/imu", kProfileFile);
  ProfileStore store;
  store.load = [file] {
    std::optional<std::string> profile;
    const std::string trouble = file->load([&profile](const std::string& text) {
      if (!bno055::read_profile(text)) throw InputError("it is no calibration of a BNO055");
      profile = text;
    });
    if (!trouble.empty()) spdlog::warn("{}", trouble);
    return profile;
  };
  store.save = [file](const std::string& text) { file->write(text); };
  return store;
}
#endif

#ifdef DYNSLAM_HAS_GPIO
/// A lidar whose motor has a line of its own: on while this lives.
class SwitchedLidar : public Lidar {
 public:
  SwitchedLidar(std::unique_ptr<Lidar> lidar, std::unique_ptr<OutputPin> motor)
      : motor_(std::move(motor)), lidar_(std::move(lidar)) {}

  std::optional<Scan> next(Time until) override {
    motor_->set(true);
    return lidar_->next(until);
  }
  std::string about() const override { return lidar_->about(); }
  Counters counters() const override { return lidar_->counters(); }

 private:
  std::unique_ptr<OutputPin> motor_;
  std::unique_ptr<Lidar> lidar_;
};
#endif

std::unique_ptr<Lidar> make_lidar(const Config& config, const Clock& clock) {
  std::unique_ptr<Lidar> lidar =
      std::make_unique<Rplidar>(config.hardware.rplidar, config.lidar.mount(), clock);
#ifdef DYNSLAM_HAS_GPIO
  if (auto motor = make_lidar_motor_pin(config.hardware.gpio))
    return std::make_unique<SwitchedLidar>(std::move(lidar), std::move(motor));
#endif
  return lidar;
}

}  // namespace

Devices make_real_devices(const Config& config, const Clock& clock) {
  const HardwareConfig& hardware = config.hardware;
  Devices devices;
  devices.lidar = make_lidar(config, clock);
  if (hardware.imu.has_imu()) {
#ifdef DYNSLAM_HAS_BNO055
    devices.imu = std::make_unique<Bno055>(hardware.imu, clock, profile_store(config.state.folder));
#else
    devices.imu = std::make_unique<NoImu>();
#endif
  }
#ifdef DYNSLAM_HAS_THUNDERBORG
  devices.motors = std::make_unique<ThunderBorg>(hardware.motors, clock);
#else
  devices.motors = std::make_unique<NoMotors>();
#endif
  if (hardware.camera.has_camera()) {
#ifdef DYNSLAM_HAS_CAMERA
    devices.camera = std::make_unique<LiveCamera>(hardware.camera, clock);
#else
    devices.camera = std::make_unique<NoCamera>();
#endif
  }
  if (hardware.gpio.has_pins()) {
#ifdef DYNSLAM_HAS_GPIO
    devices.pins = std::make_unique<GpioPins>(hardware.gpio, clock);
#else
    devices.pins = std::make_unique<NoPins>();
#endif
  }
  if (hardware.encoders.has_encoders()) {
#ifdef DYNSLAM_HAS_GPIO
    devices.wheels = std::make_unique<WheelEncoders>(hardware.encoders, clock);
#else
    devices.wheels = std::make_unique<NoWheels>();
#endif
  }
  return devices;
}

}  // namespace dynslam
