// SPDX-License-Identifier: MIT
#include "server/metrics_text.h"

#include <fstream>

#include <sys/resource.h>
#include <unistd.h>

#include "base/number_text.h"

namespace dynslam {
namespace {

class MetricsWriter {
 public:
  void begin(const std::string& name, const char* type, const char* help) {
    name_ = "dynslam_" + name;
    text_ += "# HELP " + name_ + ' ' + help + "\n# TYPE " + name_ + ' ' + type + '\n';
  }
  void value(double value, const std::string& label = {}, const std::string& of = {}) {
    text_ += name_;
    if (!label.empty()) text_ += '{' + label + "=\"" + escaped(of) + "\"}";
    text_ += ' ' + shortest_text(value) + '\n';
  }
  void one(const std::string& name, const char* type, const char* help, double number) {
    begin(name, type, help);
    value(number);
  }
  void append(const std::string& text) { text_ += text; }
  std::string text() && { return std::move(text_); }

 private:
  static std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
      if (c == '"' || c == '\\') out += '\\';
      out += c == '\n' ? ' ' : c;
    }
    return out;
  }
  std::string name_, text_;
};

double resident_bytes() {
  std::ifstream file("/proc/self/statm");
  double whole = 0.0, resident = 0.0;
  file >> whole >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

double cpu_s() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

void write_robot(const Ports& ports, MetricsWriter& out) {
  if (const auto world = ports.world.get().value) {
    out.one("pose_quality", "gauge", "how far the pose is to be trusted, 0 to 1", world->pose.quality);
    out.one("lost", "gauge", "1 when the robot does not know where it is", world->pose.lost ? 1 : 0);
    out.one("map_chunks", "gauge", "parts of the map that are in memory",
            static_cast<double>(world->map.chunk_count()));
  }
  if (const auto drive = ports.drive.get().value) {
    out.one("battery_volts", "gauge", "averaged", drive->battery.voltage_v);
    out.one("battery_ratio", "gauge", "of what it holds", drive->battery.share);
    out.one("verdict", "gauge", "0 go, 1 slow, 2 hold, 3 stop, 4 e-stop",
            static_cast<double>(drive->verdict.motion));
  }
  if (const auto autopilot = ports.autopilot.get().value)
    out.one("autopilot_phase", "gauge", "0 off, 1 drives, 2 has nothing to do, 3 cannot go on",
            static_cast<double>(autopilot->phase));
  out.one("video_watchers", "gauge", "clients that watch the video", ports.watchers.load());
}

void write_devices(const Ports& ports, MetricsWriter& out) {
  const auto write = [&](const char* name, const char* type, const char* help, auto of) {
    out.begin(name, type, help);
    for (const auto& [device, health] : ports.device_healths())
      if (const auto value = health->get().value)
        out.value(static_cast<double>(of(*value)), "device", device);
  };
  write("device_samples_total", "counter", "what it measured", [](const auto& h) { return h.samples; });
  write("device_errors_total", "counter", "how often it failed", [](const auto& h) { return h.errors; });
  write("device_ok", "gauge", "1 while it answers", [](const auto& h) { return h.trouble.empty() ? 1 : 0; });
}

void write_counters(const Ports& ports, const ServerFigures& figures, MetricsWriter& out) {
  out.begin("events_total", "counter", "what went wrong or was left out, by name");
  for (const auto& [name, n] : figures.counters) out.value(static_cast<double>(n), "event", name);
  for (const auto& [name, n] : ports.counters()) out.value(static_cast<double>(n), "event", name);
}

}  // namespace

std::string DelayHistogram::text(std::string_view name, std::string_view help) const {
  const std::string whole = "dynslam_" + std::string(name);
  std::string text = "# HELP " + whole + ' ' + std::string(help) + "\n# TYPE " + whole + " histogram\n";
  for (std::size_t i = 0; i < kBounds_ms.size(); ++i)
    text += whole + "_bucket{le=\"" + shortest_text(1e-3 * kBounds_ms[i]) + "\"} " +
            std::to_string(counts_[i]) + '\n';
  text += whole + "_bucket{le=\"+Inf\"} " + std::to_string(count_) + '\n';
  text += whole + "_sum " + shortest_text(sum_s_) + '\n';
  return text + whole + "_count " + std::to_string(count_) + '\n';
}

std::string metrics_text(const Ports& ports, const ServerFigures& figures) {
  MetricsWriter out;
  out.one("resident_memory_bytes", "gauge", "of this program", resident_bytes());
  out.one("cpu_seconds_total", "counter", "of this program", cpu_s());
  out.one("connections", "gauge", "open to the server", static_cast<double>(figures.connections));
  write_robot(ports, out);
  write_devices(ports, out);
  write_counters(ports, figures, out);
  out.append(figures.command_to_motor.text("command_to_motor_seconds",
                                           "from a driver's command to the motors' power"));
  out.append(figures.drop_to_off.text("drop_to_off_seconds", "from a lost driver to motors without power"));
  return std::move(out).text();
}

}  // namespace dynslam
