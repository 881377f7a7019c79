// SPDX-License-Identifier: MIT
#include "caretaker.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

#include <spdlog/spdlog.h>

#include "drivers/pi/pi_watch.h"
#ifdef DYNSLAM_HAS_GPIO
#include "drivers/gpio/output_pin.h"
#include "drivers/gpio/status_light.h"
#endif

namespace dynslam {
namespace {

constexpr Duration kLightEvery = std::chrono::milliseconds(50);
constexpr Duration kLookEvery = std::chrono::seconds(1);

}  // namespace

struct Caretaker::Things {
  explicit Things(std::filesystem::path root) : computer(std::move(root)) {}

  PiWatch computer;
  DeviceHealth health;
  Time look_at, light_at;
  std::map<std::string, std::string> told;  ///< the trouble of each device
#ifdef DYNSLAM_HAS_GPIO
  std::unique_ptr<OutputPin> light;
#endif
};

Caretaker::Caretaker(Ports& ports, const Clock& clock, [[maybe_unused]] const Config& config,
                     std::filesystem::path root)
    : ports_(ports), clock_(clock), things_(std::make_unique<Things>(std::move(root))) {
#ifdef DYNSLAM_HAS_GPIO
  things_->light = make_status_light_pin(config.hardware.gpio);
#endif
  thread_ = std::thread([this] { run(); });
}

Caretaker::~Caretaker() {
  ends_.request();
  thread_.join();
}

void Caretaker::run() {
  Time due = clock_.now();
  while (!ends_.wait(clock_.steady(due))) {
    due = clock_.now() + kLightEvery;
    show_light();
    tell_troubles();
    if (clock_.now() >= things_->look_at) look_at_computer();
  }
}

/// In the log, when one begins and when it ends.
void Caretaker::tell_troubles() {
  for (const auto& [name, health] : ports_.device_healths()) {
    if (health == &ports_.computer_health) continue;  // told where it is looked at
    const auto now = health->get().value;
    std::string& told = things_->told[name];
    if (!now || now->trouble == told) continue;
    told = now->trouble;
    if (told.empty()) {
      spdlog::info("{} answers", name);
    } else {
      spdlog::warn("{}", told);
    }
  }
}

void Caretaker::show_light() {
#ifdef DYNSLAM_HAS_GPIO
  const auto drive = ports_.drive.get().value;
  if (!things_->light || !drive || clock_.now() < things_->light_at) return;
  std::string& told = things_->told["light"];
  try {
    things_->light->set(status_light(drive->verdict.motion, clock_.now()));
    told.clear();
  } catch (const DeviceError& e) {
    // A robot without its light drives as well.
    things_->light_at = clock_.now() + kLookEvery;
    if (told != e.what()) spdlog::warn("{}", e.what());
    told = e.what();
  }
#endif
}

void Caretaker::look_at_computer() {
  const Time now = clock_.now();
  things_->look_at = now + kLookEvery;
  const PiState state = things_->computer.read();
  ports_.supply_low = state.under_voltage.value_or(false);
  DeviceHealth& health = things_->health;
  health.present = state.flags || state.under_voltage || state.temperature_c;
  if (!health.present) return;
  ++health.samples;
  health.last_sample = now;
  const std::vector<std::string> advice = state.advice();
  const std::string trouble = advice.empty() ? "" : advice.front();
  if (!trouble.empty() && trouble != health.trouble) spdlog::warn("{}", trouble);
  health.trouble = trouble;
  ports_.computer_health.put(health);
}

}  // namespace dynslam
