// SPDX-License-Identifier: MIT
#include "bench/summary.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "grid/chunk.h"

namespace dynslam::bench {
namespace {

constexpr double kGiga = 1e9, kMicro = 1e-6;

/// The better of copying and adding: what the machine can do at this distance from the core. NaN when neither
/// ran.
double bandwidth(const RunTable& runs, const std::string& where) {
  return std::fmax(runs.value("bandwidth_copy/" + where, "bytes/s"),
                   runs.value("bandwidth_add/" + where, "bytes/s"));
}

void print_clearing(const RunTable& runs) {
  std::printf("\nclearing a scan\n  %-24s %9s %9s %11s %12s %10s %11s\n", "", "rays us", "spans us",
              "rays/spans", "tracing us", "apply us", "sure/young");
  for (const std::string& name : runs.cases_of("clear_spans")) {
    const auto us = [&](const char* what) { return runs.value(what + name, "s/scan") / kMicro; };
    const double rays = us("clear_rays/"), spans = us("clear_spans/");
    std::printf("  %-24s %9.1f %9.1f %11.1f %12.1f %10.1f %11.2f\n", name.c_str(), rays, spans, rays / spans,
                us("trace_alone/"), us("apply_alone/"), us("clear_spans_sure/") / spans);
  }
}

/// One line: how fast one way of clearing touches cells.
void print_traffic(const RunTable& runs, const std::string& run) {
  const double bytes = runs.value(run, "bytes/s");
  std::printf("  %-36s %8.2f %9.3f %8.2f %10.1f%% %6.1f%%\n", run.c_str(), runs.value(run, "cells/s") / kGiga,
              kGiga / runs.value(run, "cells/s"), bytes / kGiga, 100 * bytes / bandwidth(runs, "memory"),
              100 * bytes / bandwidth(runs, "L2"));
}

void print_clearing_traffic(const RunTable& runs) {
  std::printf(
      "\ncells touched, both bytes of each read and written, beside what the machine moves in the same run:\n"
      "memory %.1f GB/s, second-level cache %.1f GB/s\n",
      bandwidth(runs, "memory") / kGiga, bandwidth(runs, "L2") / kGiga);
  std::printf("  %-36s %8s %9s %8s %11s %7s\n", "", "G cell/s", "ns a cell", "GB/s", "of memory", "of L2");
  for (const char* what : {"clear_rays", "clear_spans", "apply_alone"}) {
    for (const std::string& name : runs.cases_of(what)) print_traffic(runs, std::string(what) + "/" + name);
  }
}

void print_matching(const RunTable& runs) {
  std::printf(
      "\nmatching a scan; the kernel of the search: sums for 16 shifts, a load of 16 bytes a point, against "
      "a byte\n"
      "at a time\n");
  std::printf("  %-24s %10s %9s %12s %14s %16s %14s\n", "", "narrow us", "wide us", "wide/narrow",
              "kernel Gload/s", "plain Gload/s", "sums, ratio");
  for (const std::string& name : runs.cases_of("match_narrow")) {
    const double narrow = runs.value("match_narrow/" + name, "s/scan"),
                 wide = runs.value("match_wide/" + name, "s/scan");
    const double kernel = runs.value("score_16_shifts/" + name, "looks/s");
    const double plain = runs.value("score_one_by_one/" + name, "looks/s");
    std::printf("  %-24s %10.1f %9.1f %12.1f %14.2f %16.2f %14.1f\n", name.c_str(), narrow / kMicro,
                wide / kMicro, wide / narrow, kernel / 16 / kGiga, plain / kGiga, kernel / plain);
  }
}

void print_snapshots(const RunTable& runs) {
  for (const std::string& name : runs.cases_of("snapshot")) {
    const double take = runs.value("snapshot/" + name, "s/chunk");
    const double first = runs.value("write_after_snapshot/" + name, "s/chunk");
    const double again = runs.value("write_again/" + name, "s/chunk");
    std::printf("\nsnapshot of %.0f chunks (%s): %.1f us, %.1f ns a chunk\n",
                runs.value("snapshot/" + name, "chunks"), name.c_str(),
                take * runs.value("snapshot/" + name, "chunks") / kMicro, take * kGiga);
    std::printf("  first write to a chunk %.0f ns, a later one %.1f ns; cloning moves %.1f GB/s\n",
                first * kGiga, again * kGiga, 2 * sizeof(Chunk) / (first - again) / kGiga);
  }
}

void print_map_work(const RunTable& runs) {
  for (const std::string& name : runs.cases_of("flood_fill")) {
    const double find = runs.value("free_cells/" + name, "s/chunk"),
                 fill = runs.value("flood_fill/" + name, "s/chunk");
    std::printf("  finding its free cells %.2f us a chunk, filling them %.2f us (%.2f G cells/s)\n",
                find / kMicro, fill / kMicro, runs.value("flood_fill/" + name, "cells/s") / kGiga);
  }
}

void print_casting(const RunTable& runs) {
  std::printf("\ncasting a turn of 1200 beams in the simulator\n  %-24s %9s %12s %7s\n", "", "us",
              "plainly us", "ratio");
  for (const std::string& name : runs.cases_of("cast_fast")) {
    const double fast = runs.value("cast_fast/" + name, "s/scan"),
                 plain = runs.value("cast_plainly/" + name, "s/scan");
    std::printf("  %-24s %9.1f %12.1f %7.1f\n", name.c_str(), fast / kMicro, plain / kMicro, plain / fast);
  }
}

void print_memory(const RunTable& runs) {
  std::printf(
      "\nmap of a whole recording; the ratio is its bytes to two bytes for each cell it knows (at most 1.5 "
      "and what\n"
      "chunks known in part add)\n");
  std::printf("  %-24s %8s %12s %12s %12s %7s %11s %9s\n", "", "chunks", "chunk bytes", "table bytes",
              "cells known", "ratio", "of its cells", "scans/s");
  for (const std::string& name : runs.cases_of("replay")) {
    const std::string run = "replay/" + name;
    const double chunks = runs.value(run, "chunks"), known = runs.value(run, "cells_known");
    const double chunk_bytes = chunks * sizeof(Chunk);
    std::printf("  %-24s %8.0f %12.0f %12.0f %12.0f %7.2f %10.0f%% %9.0f\n", name.c_str(), chunks,
                chunk_bytes, runs.value(run, "map_bytes") - chunk_bytes, known,
                runs.value(run, "bytes/2/cell"), 100 * known / (chunks * kChunkSide * kChunkSide),
                runs.value(run, "scans/s"));
  }
}

void print_growth(const std::vector<GrowthSeries>& all) {
  std::printf(
      "\nwork on a finished local map, ms, and the power of the number of local maps it grows with\n");
  for (const GrowthSeries& series : all) {
    std::printf("  %-16s", series.name.c_str());
    for (const auto& [maps, ms] : series.points) std::printf(" %4.0f: %8.3f", maps, ms);
    if (series.points.size() > 1) std::printf("   power %.2f", growth_exponent(series));
    std::printf("\n");
  }
}

}  // namespace

std::vector<GrowthSeries> growth_of(const RunTable& runs) {
  constexpr double kMilli = 1e-3;
  std::vector<GrowthSeries> all;
  const double clean_up = runs.value("clean_up", "cpu_s");
  if (clean_up > 0.0) all.push_back({"clean_up", {{1.0, clean_up / kMilli}}});
  for (const std::string what : {"loop_search", "solve", "solve_all_new", "redraw"}) {
    GrowthSeries series{what, {}};
    for (const std::string& size : runs.cases_of(what)) {
      const std::string run = what + "/" + size;
      series.points.push_back({runs.value(run, "maps"), runs.value(run, "cpu_s") / kMilli});
    }
    std::sort(series.points.begin(), series.points.end(),
              [](const auto& a, const auto& b) { return a.maps < b.maps; });
    if (!series.points.empty()) all.push_back(std::move(series));
  }
  return all;
}

void print_summary(const RunTable& runs) {
  if (!runs.cases_of("clear_spans").empty()) print_clearing(runs);
  if (!runs.cases_of("clear_spans").empty()) print_clearing_traffic(runs);
  if (!runs.cases_of("match_narrow").empty()) print_matching(runs);
  if (!runs.cases_of("replay").empty()) print_memory(runs);
  if (const auto growth = growth_of(runs); !growth.empty()) print_growth(growth);
  if (!runs.cases_of("cast_fast").empty()) print_casting(runs);
  print_snapshots(runs);
  print_map_work(runs);
}

}  // namespace dynslam::bench
