// SPDX-License-Identifier: MIT
#include "bench_report.h"

#include <algorithm>
#include <array>
#include <utility>

#include "print.h"

namespace dynslam {
namespace {

constexpr double kMib = 1024.0 * 1024.0;

constexpr std::array<std::pair<Work, const char*>, kWorks> kRows = {
    {{Work::kSensing, "samples taken in, a scan"},
     {Work::kMapping, "mapping, a scan"},
     {Work::kLoops, "closing loops, a local map"},
     {Work::kPlanning, "planning, a turn"},
     {Work::kPiloting, "following the route"},
     {Work::kControlling, "safety and motors, a tick"},
     {Work::kServing, "a client, a message"},
     {Work::kPicturing, "a picture as JPEG"}}};

/// Without what would end it early, or the line.
std::string quoted(std::string text) {
  std::replace_if(
      text.begin(), text.end(),
      [](char c) { return c == '"' || static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, ' ');
  return '"' + text + '"';
}

std::string row(const BenchFigures& figures, Work work, const char* name) {
  const WorkCost& cost = figures.cost(work);
  return print("%-28s%8zu%10.3f%10.3f%9.1f %%\n", name, cost.ms.size(), cost.mean_ms(), cost.p99_ms(),
               100.0 * share_of_core(figures, work));
}

std::string in_words(const Machine& m) {
  std::string text = m.model.empty() ? "a computer of an unknown kind" : m.model;
  text += print(": %u cores", m.cores);
  if (m.most_mhz > 0) text += print(" of %d MHz", m.most_mhz);
  if (!m.governor.empty()) text += " (" + m.governor + ")";
  text += ", " + m.architecture;
  if (m.memory_mib > 0) text += print(", %d MiB", m.memory_mib);
  if (m.temperature_c) text += print(", %.0f degrees", *m.temperature_c);
  return text;
}

}  // namespace

double share_of_core(const BenchFigures& figures, Work work) {
  const double total_s = 1e-3 * figures.cost(work).total_ms();
  switch (work) {
    case Work::kPicturing:
      return 1e-3 * figures.cost(work).mean_ms() * kBenchPicturesASecond;
    case Work::kPlanning:
    case Work::kPiloting:
    case Work::kControlling:
      return figures.drive_s > 0.0 ? total_s / figures.drive_s : 0.0;
    default:
      return figures.scans > 0 ? total_s / static_cast<double>(figures.scans) * kBenchScansASecond : 0.0;
  }
}

double share_of_core(const BenchFigures& figures) {
  double sum = 0.0;
  for (const auto& [work, name] : kRows)
    if (work != Work::kPicturing) sum += share_of_core(figures, work);
  return sum;
}

std::string bench_table(const BenchFigures& figures) {
  std::string text = "dynslam " + figures.version + " on " + in_words(figures.machine) + '\n';
  text +=
      print("%.0f s of exploring, %.0f m, %zu scans: %s, seed %llu\n\n", figures.drive_s, figures.driven_m,
            figures.scans, figures.world.c_str(), static_cast<unsigned long long>(figures.seed));
  text += print("%-28s%8s%10s%10s%11s\n", "CPU time", "times", "mean ms", "p99 ms", "of a core");
  for (const auto& [work, name] : kRows)
    if (work != Work::kPicturing) text += row(figures, work, name);
  text += print("%-56s%9.1f %%\n", print("together, at %.1f scans a second", kBenchScansASecond).c_str(),
                100.0 * share_of_core(figures));
  text += row(figures, Work::kPicturing, kRows[kWorks - 1].second);
  text += print("%24s(while somebody watches, %.0f a second)\n\n", "", kBenchPicturesASecond);
  text +=
      print("memory %.0f MiB at the most; a client is sent %.0f kB a second\n",
            static_cast<double>(figures.peak_rss_bytes) / kMib,
            figures.drive_s > 0.0 ? 1e-3 * static_cast<double>(figures.client_bytes) / figures.drive_s : 0.0);
  text += print("not counted: the simulator (%.1f s); not there: drivers, sockets, recording\n",
                figures.simulator_s);
  for (const std::string& line : figures.machine.advice) text += line + '\n';
  return text;
}

std::string bench_line(const BenchFigures& figures) {
  const Machine& m = figures.machine;
  std::string line =
      "dynslam-bench: version=" + figures.version + " model=" + quoted(m.model) + " arch=" + m.architecture;
  line += print(" cores=%u mhz=%d ram_mib=%d", m.cores, m.most_mhz, m.memory_mib);
  line += " governor=" + (m.governor.empty() ? "?" : m.governor);
  line += m.temperature_c ? print(" temp_c=%.0f", *m.temperature_c) : " temp_c=?";
  line += m.throttled ? print(" throttled=0x%x", *m.throttled) : " throttled=?";
  line += " world=" + quoted(figures.world);
  line += print(" seed=%llu drive_s=%.0f scans=%zu", static_cast<unsigned long long>(figures.seed),
                figures.drive_s, figures.scans);
  const auto cost = [&](const char* name, Work work) {
    line += print(" %s_ms=%.3f/%.3f", name, figures.cost(work).mean_ms(), figures.cost(work).p99_ms());
  };
  cost("map", Work::kMapping);
  cost("loops", Work::kLoops);
  cost("plan", Work::kPlanning);
  cost("control", Work::kControlling);
  cost("client", Work::kServing);
  cost("jpeg", Work::kPicturing);
  return line + print(" core_pct=%.1f jpeg_pct=%.1f rss_mib=%.0f", 100.0 * share_of_core(figures),
                      100.0 * share_of_core(figures, Work::kPicturing),
                      static_cast<double>(figures.peak_rss_bytes) / kMib);
}

}  // namespace dynslam
