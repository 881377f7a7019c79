// SPDX-License-Identifier: MIT
#include "probe_command.h"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <functional>
#include <istream>
#include <optional>
#include <ostream>
#include <string>
#include <thread>

#include "drivers/pi/pi_watch.h"
#include "drivers/rplidar/rplidar.h"
#include "pipe/clock.h"
#include "print.h"
#include "scan_text.h"
#ifdef DYNSLAM_HAS_BNO055
#include "drivers/bno055/bno055.h"
#endif
#ifdef DYNSLAM_HAS_THUNDERBORG
#include "drivers/thunderborg/thunderborg.h"
#endif
#ifdef DYNSLAM_HAS_CAMERA
#include "drivers/camera/frame_source.h"
#endif
#ifdef DYNSLAM_HAS_GPIO
#include "drivers/gpio/chips.h"
#include "drivers/gpio/gpio_pins.h"
#include "drivers/gpio/output_pin.h"
#include "drivers/gpio/wheel_encoders.h"
#endif

namespace dynslam {
namespace {

/// Devices are waited for in such steps, so that Ctrl-C is heard.
constexpr Duration kMoment = std::chrono::milliseconds(100);
constexpr Duration kLidarPatience = std::chrono::seconds(8);
constexpr Duration kImuPatience = std::chrono::seconds(3);
[[maybe_unused]] constexpr Duration kWheelPatience = std::chrono::milliseconds(100);
constexpr double kDegree = kTwoPi / 360.0;

volatile std::sig_atomic_t stop_signal = 0;

/// Somebody does not want to know any more. What is asked is left as it is at an end: motors stand.
struct Interrupted {};
void heed_signals() {
  if (stop_signal != 0) throw Interrupted();
}
void catch_signals() {
  struct sigaction action {};
  action.sa_handler = [](int signal) { stop_signal = signal; };
  action.sa_flags = 0;  // not SA_RESTART: a question that waits for its answer ends too
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaction(signal, &action, nullptr);
}

/// Writes what each device says, and counts those that do not answer.
class Prober {
 public:
  Prober(const Config& config, std::ostream& out) : config_(config), out_(out) {}

  void lidar();
  void imu();
  void motors(bool spins, std::istream& in);
  void camera();
  void pins();
  void wheels();
  void computer();
  int silent() const { return silent_; }

 private:
  void say(const char* device, const std::string& text) { out_ << print("%-9s", device) << text << '\n'; }
  void more(const std::string& text) { out_ << print("%-9s", "") << text << '\n'; }
  void ask(const char* device, const std::function<void()>& question);
#ifdef DYNSLAM_HAS_THUNDERBORG
  void spin(ThunderBorg& board, std::istream& in);
#endif

  const Config& config_;
  std::ostream& out_;
  RunningClock clock_;
  int silent_ = 0;
};

void Prober::ask(const char* device, const std::function<void()>& question) {
  try {
    question();
  } catch (const DeviceError& e) {
    say(device, std::string("does not answer. ") + e.what());
    ++silent_;
  }
  out_.flush();
  heed_signals();
}

void Prober::lidar() {
  ask("lidar", [&] {
#ifdef DYNSLAM_HAS_GPIO
    const auto motor = make_lidar_motor_pin(config_.hardware.gpio);
    if (motor) motor->set(true);
#endif
    Rplidar lidar(config_.hardware.rplidar, config_.lidar.mount(), clock_);
    const Time until = clock_.now() + kLidarPatience;
    while (!lidar.identify(clock_.now() + kMoment)) {
      heed_signals();
      if (clock_.now() > until)
        throw DeviceError("lidar: it began to answer, and stopped: is its supply strong enough?");
    }
    const rplidar::Portrait& p = lidar.report().device;
    say("lidar", print("%s, firmware %s, hardware %d, on %s at %d baud",
                       p.info ? p.info->model_name().c_str() : "of an unknown kind",
                       p.info ? p.info->firmware().c_str() : "?", p.info ? p.info->hardware : 0,
                       p.port.c_str(), p.baud));
    if (p.health) more("health: " + rplidar::in_words(*p.health));
    for (const rplidar::ScanMode& mode : p.modes)
      more(print("%s mode %s: %.0f beams a second, up to %.0f m",
                 p.mode && p.mode->name == mode.name ? "*" : " ", mode.name.c_str(),
                 mode.sample_us > 0.0 ? 1e6 / mode.sample_us : 0.0, mode.max_range_m));
    std::optional<Scan> scan;
    while (!scan && clock_.now() < until) {
      scan = lidar.next(clock_.now() + kMoment);
      heed_signals();
    }
    if (!scan) throw DeviceError("lidar: it does not turn: is its motor supplied, is anything caught in it?");
    const auto returns = std::count_if(scan->beams.begin(), scan->beams.end(), is_return);
    more(print("a turn has %zu beams, %td of them come back:", scan->beams.size(), returns));
    out_ << scan_text(*scan, 4.0);
  });
}

void Prober::imu() {
  if (!config_.hardware.imu.has_imu()) return say("imu", "none, says imu.bus");
#ifdef DYNSLAM_HAS_BNO055
  ask("imu", [&] {
    Bno055 imu(config_.hardware.imu, clock_);
    std::optional<ImuSample> sample;
    const Time until = clock_.now() + kImuPatience;
    while (!sample && clock_.now() < until) {
      sample = imu.next(clock_.now() + kMoment);
      heed_signals();
    }
    if (!sample)
      throw DeviceError(
          "imu: it answers, but measures nothing: give it a moment of rest, or its supply off and on");
    const Bno055Report report = imu.report();
    say("imu", print("BNO055, software %x.%02x, on %s%s", report.identity.software >> 8,
                     report.identity.software & 0xff, config_.hardware.imu.bus.c_str(),
                     report.on_software_bus ? " (a bus by software: 50 readings a second)" : ""));
    more(print("heading %.1f degrees, %d degrees warm", yaw_of(sample->world_q_robot) / kDegree,
               report.status.temperature_c));
    const bno055::Calibration& c = report.status.calibration;
    more(print("calibrated (0 to 3): gyroscope %d, accelerometer %d, compass %d", c.gyroscope,
               c.accelerometer, c.magnetometer));
  });
#else
  say("imu", "this program was built without its driver");
  ++silent_;
#endif
}

#ifdef DYNSLAM_HAS_THUNDERBORG
/// A quarter of a second forwards and back, slowly.
void Prober::spin(ThunderBorg& board, std::istream& in) {
  out_ << "The wheels will turn slowly for half a second. Lift the robot, and answer yes: " << std::flush;
  std::string answer;
  std::getline(in, answer);
  if (answer != "yes") return more("the wheels were left alone");
  for (const double power : {0.25, -0.25}) {
    const Time until = clock_.now() + std::chrono::milliseconds(250);
    while (clock_.now() < until && stop_signal == 0) {
      board.drive({power, power});
      std::this_thread::sleep_until(clock_.steady(clock_.now() + std::chrono::milliseconds(20)));
    }
  }
  board.drive({0.0, 0.0});
  more("did both wheels turn forwards first? If not: motors.invert_a, invert_b, swap");
}
#endif

void Prober::motors([[maybe_unused]] bool spins, [[maybe_unused]] std::istream& in) {
#ifdef DYNSLAM_HAS_THUNDERBORG
  ask("motors", [&] {
    ThunderBorg board(config_.hardware.motors, clock_);
    const ThunderBorgReport report = board.report();
    say("motors", print("ThunderBorg on %s, battery %.1f V, failsafe %s", config_.hardware.motors.bus.c_str(),
                        report.battery_v, report.failsafe_on ? "on" : "OFF"));
    if (report.fault_a || report.fault_b)
      more("a fault is reported; it goes when both motors were driven once");
    if (spins) spin(board, in);
  });
#else
  say("motors", "this program was built without their driver");
  ++silent_;
#endif
}

void Prober::camera() {
  if (!config_.hardware.camera.has_camera()) return say("camera", "none, says camera.name");
#ifdef DYNSLAM_HAS_CAMERA
  ask("camera", [&] {
    const auto cameras = list_cameras();
    if (cameras.empty())
      throw DeviceError(
          "camera: there is none: is its cable in the right way round, and does rpicam-hello find it? The "
          "robot drives without");
    for (const CameraInfo& camera : cameras) say("camera", camera.model + ", " + camera.id);
  });
#else
  say("camera", "this program was built without its driver");
  ++silent_;
#endif
}

void Prober::pins() {
  if (!config_.hardware.gpio.has_pins())
    return say("pins", "none are named: gpio.estop_line, gpio.bumper_lines");
#ifdef DYNSLAM_HAS_GPIO
  ask("pins", [&] {
    GpioPins pins(config_.hardware.gpio, clock_);
    const PinState state = pins.read();
    say("pins",
        std::string("e-stop ") + (state.estop_pressed ? "pressed" : "released") +
            (state.bumper_pressed ? *state.bumper_pressed ? ", a bumper pressed" : ", no bumper pressed"
                                  : ""));
  });
#else
  say("pins", "this program was built without their driver");
  ++silent_;
#endif
}

void Prober::wheels() {
  if (!config_.hardware.encoders.has_encoders()) return;  // few robots have them
#ifdef DYNSLAM_HAS_GPIO
  ask("wheels", [&] {
    WheelEncoders encoders(config_.hardware.encoders, clock_);
    encoders.next(clock_.now() + kWheelPatience);
    say("wheels", encoders.about());
  });
#else
  say("wheels", "this program was built without their driver");
  ++silent_;
#endif
}

void Prober::computer() {
  const PiWatch watch;
  const PiState state = watch.read();
  const std::string model = watch.model().empty() ? "not a Raspberry Pi" : watch.model();
  say("computer", model + (state.temperature_c ? print(", %.0f degrees", *state.temperature_c) : ""));
  for (const std::string& line : state.advice()) more(line);
}

}  // namespace

int run_probe(const ProbeOptions& options, const Config& config, std::istream& in, std::ostream& out) {
  catch_signals();
  Prober prober(config, out);
  try {
    prober.lidar();
    prober.imu();
    prober.motors(options.spin_motors, in);
    prober.camera();
    prober.pins();
    prober.wheels();
    prober.computer();
  } catch (const Interrupted&) {
    return 128 + stop_signal;
  }
  return prober.silent() == 0 ? 0 : 1;
}

}  // namespace dynslam
