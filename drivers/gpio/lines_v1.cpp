// SPDX-License-Identifier: MIT
// Over libgpiod 1: a kernel handle for each line.
#include <algorithm>
#include <array>
#include <cerrno>
#include <ctime>

#include <gpiod.h>

#include "drivers/gpio/chips.h"

namespace dynslam {
namespace {

using Chip = std::unique_ptr<gpiod_chip, void (*)(gpiod_chip*)>;

constexpr std::size_t kKernelKeeps = 16;  ///< edges of a line

Chip open_chip(const std::string& path, const std::string& who) {
  Chip chip(gpiod_chip_open(path.c_str()), gpiod_chip_close);
  if (!chip) throw chip_error(who, path, errno);
  return chip;
}

int flags_of(const LineUse& use) {
  int flags = use.active_low ? GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW : 0;
  if (use.pull == Pull::kUp) flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP;
  if (use.pull == Pull::kDown) flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN;
  return flags;
}

gpiod_line* request(gpiod_chip* chip, const std::string& path, const LineUse& use, int type, bool active,
                    const std::string& who) {
  const std::string consumer = "dynslam " + who;
  const gpiod_line_request_config config{consumer.c_str(), type, flags_of(use)};
  gpiod_line* const line = gpiod_chip_get_line(chip, use.offset);
  if (!line || gpiod_line_request(line, &config, active ? 1 : 0) < 0)
    throw line_error(who, path, use.offset, errno);
  return line;
}

timespec time_left(Clock::SteadyTime until) {
  const auto left = std::max(until - std::chrono::steady_clock::now(), Clock::SteadyTime::duration(0));
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(left);
  return {whole.count(), std::chrono::nanoseconds(left - whole).count()};
}

Clock::SteadyTime time_of(const timespec& t) {
  return Clock::SteadyTime(std::chrono::seconds(t.tv_sec) + std::chrono::nanoseconds(t.tv_nsec));
}

class Inputs : public InputLines {
 public:
  Inputs(const std::string& path, std::span<const LineUse> uses, const std::string& who)
      : path_(path), who_(who), chip_(open_chip(path, who)) {
    gpiod_line_bulk_init(&lines_);
    for (const LineUse& use : uses) {
      constexpr int kEdges = GPIOD_LINE_REQUEST_EVENT_BOTH_EDGES;
      gpiod_line_bulk_add(&lines_, request(chip_.get(), path, use, kEdges, false, who));
    }
  }

  void read(std::span<bool> active) override {
    for (unsigned i = 0; i < lines_.num_lines; ++i) {
      const int value = gpiod_line_get_value(lines_.lines[i]);
      if (value < 0) fail(i);
      active[i] = value == 1;
    }
  }

  std::size_t take_edges(std::span<LineEdge> edges, Clock::SteadyTime until) override {
    const timespec patience = time_left(until);
    gpiod_line_bulk ready;
    const int any = gpiod_line_event_wait_bulk(&lines_, &patience, &ready);
    if (any < 0 && errno != EINTR) fail(0);
    if (any <= 0) return 0;
    std::size_t taken = 0;
    for (unsigned i = 0; i < lines_.num_lines && taken < edges.size(); ++i) {
      if (is_among(ready, lines_.lines[i])) taken += take_edges_of(i, edges.subspan(taken));
    }
    const auto begin = edges.begin();
    std::sort(begin, begin + static_cast<std::ptrdiff_t>(taken),
              [](const LineEdge& a, const LineEdge& b) { return a.at < b.at; });
    return taken;
  }

 private:
  static bool is_among(const gpiod_line_bulk& bulk, const gpiod_line* line) {
    return std::find(bulk.lines, bulk.lines + bulk.num_lines, line) != bulk.lines + bulk.num_lines;
  }

  std::size_t take_edges_of(unsigned i, std::span<LineEdge> edges) {
    std::array<gpiod_line_event, kKernelKeeps> events;
    const auto room = static_cast<unsigned>(std::min(edges.size(), events.size()));
    const int count = gpiod_line_event_read_multiple(lines_.lines[i], events.data(), room);
    if (count < 0) fail(i);
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
      edges[k] = {i, events[k].event_type == GPIOD_LINE_EVENT_RISING_EDGE, time_of(events[k].ts)};
    return static_cast<std::size_t>(count);
  }

  [[noreturn]] void fail(unsigned i) const {
    const int error = errno;
    throw line_error(who_, path_, gpiod_line_offset(lines_.lines[i]), error);
  }

  std::string path_, who_;
  Chip chip_;  ///< gives its lines back when it goes
  gpiod_line_bulk lines_;
};

class Output : public OutputLine {
 public:
  Output(const std::string& path, const LineUse& use, bool active, const std::string& who)
      : path_(path), who_(who), chip_(open_chip(path, who)) {
    line_ = request(chip_.get(), path, use, GPIOD_LINE_REQUEST_DIRECTION_OUTPUT, active, who);
  }

  void set(bool active) override {
    if (gpiod_line_set_value(line_, active ? 1 : 0) < 0)
      throw line_error(who_, path_, gpiod_line_offset(line_), errno);
  }

 private:
  std::string path_, who_;
  Chip chip_;
  gpiod_line* line_ = nullptr;
};

}  // namespace

ChipInfo ask_chip(const std::string& path) {
  const Chip chip(gpiod_chip_open(path.c_str()), gpiod_chip_close);
  if (!chip) return {path, {}, 0, errno};
  return {path, gpiod_chip_label(chip.get()), gpiod_chip_num_lines(chip.get())};
}

std::unique_ptr<InputLines> open_inputs(const std::string& chip_path, std::span<const LineUse> uses,
                                        const std::string& who) {
  return std::make_unique<Inputs>(chip_path, uses, who);
}

std::unique_ptr<OutputLine> open_output(const std::string& chip_path, const LineUse& use, bool active,
                                        const std::string& who) {
  return std::make_unique<Output>(chip_path, use, active, who);
}

}  // namespace dynslam
