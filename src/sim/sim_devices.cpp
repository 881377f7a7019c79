// SPDX-License-Identifier: MIT
#include "sim/camera_picture.h"
#include "sim/simulator.h"

namespace dynslam {
namespace {

using SimulatorPtr = std::shared_ptr<Simulator>;

class SimLidar : public Lidar {
 public:
  explicit SimLidar(SimulatorPtr simulator) : simulator_(std::move(simulator)) {}
  std::optional<Scan> next(Time until) override { return simulator_->next_scan(until); }

 private:
  SimulatorPtr simulator_;
};

class SimImu : public Imu {
 public:
  explicit SimImu(SimulatorPtr simulator) : simulator_(std::move(simulator)) {}
  std::optional<ImuSample> next(Time until) override { return simulator_->next_imu(until); }

 private:
  SimulatorPtr simulator_;
};

class SimMotors : public Motors {
 public:
  explicit SimMotors(SimulatorPtr simulator) : simulator_(std::move(simulator)) {}
  void drive(const WheelPower& power) override { simulator_->drive(power); }
  MotorState read() override { return simulator_->read_motors(); }

 private:
  SimulatorPtr simulator_;
};

/// Draws only what is asked for, in the caller's thread.
class SimCamera : public Camera {
 public:
  explicit SimCamera(SimulatorPtr simulator) : simulator_(std::move(simulator)) {}
  std::optional<JpegFrame> next(Time until) override {
    const auto view = simulator_->next_view(until);
    if (!view) return std::nullopt;
    if (!picture_) picture_.emplace(simulator_->world());
    return JpegFrame{view->stamp, encode_jpeg(picture_->draw(*view))};
  }

 private:
  SimulatorPtr simulator_;
  std::optional<CameraPicture> picture_;
};

class SimPins : public Pins {
 public:
  explicit SimPins(SimulatorPtr simulator) : simulator_(std::move(simulator)) {}
  PinState read() override { return simulator_->read_pins(); }

 private:
  SimulatorPtr simulator_;
};

}  // namespace

Devices make_devices(const std::shared_ptr<Simulator>& simulator) {
  Devices devices;
  devices.lidar = std::make_unique<SimLidar>(simulator);
  devices.imu = std::make_unique<SimImu>(simulator);
  devices.motors = std::make_unique<SimMotors>(simulator);
  devices.camera = std::make_unique<SimCamera>(simulator);
  devices.pins = std::make_unique<SimPins>(simulator);
  return devices;
}

}  // namespace dynslam
