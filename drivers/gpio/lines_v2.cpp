// SPDX-License-Identifier: MIT
// Over libgpiod 2: one kernel handle for all lines of a request.
#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <vector>

#include <gpiod.h>

#include "drivers/gpio/chips.h"

namespace dynslam {
namespace {

using Chip = std::unique_ptr<gpiod_chip, void (*)(gpiod_chip*)>;
using Info = std::unique_ptr<gpiod_chip_info, void (*)(gpiod_chip_info*)>;
using Settings = std::unique_ptr<gpiod_line_settings, void (*)(gpiod_line_settings*)>;
using LineConfig = std::unique_ptr<gpiod_line_config, void (*)(gpiod_line_config*)>;
using RequestConfig = std::unique_ptr<gpiod_request_config, void (*)(gpiod_request_config*)>;
using Request = std::unique_ptr<gpiod_line_request, void (*)(gpiod_line_request*)>;
using Edges = std::unique_ptr<gpiod_edge_event_buffer, void (*)(gpiod_edge_event_buffer*)>;

constexpr std::size_t kEdgesAtOnce = 64;

Chip open_chip(const std::string& path, const std::string& who) {
  Chip chip(gpiod_chip_open(path.c_str()), gpiod_chip_close);
  if (!chip) throw chip_error(who, path, errno);
  return chip;
}

Settings input_settings(const LineUse& use) {
  Settings settings(gpiod_line_settings_new(), gpiod_line_settings_free);
  if (!settings) return settings;
  gpiod_line_settings_set_direction(settings.get(), GPIOD_LINE_DIRECTION_INPUT);
  gpiod_line_settings_set_edge_detection(settings.get(), GPIOD_LINE_EDGE_BOTH);
  gpiod_line_settings_set_event_clock(settings.get(), GPIOD_LINE_CLOCK_MONOTONIC);
  gpiod_line_settings_set_active_low(settings.get(), use.active_low);
  gpiod_line_settings_set_bias(settings.get(), use.pull == Pull::kUp     ? GPIOD_LINE_BIAS_PULL_UP
                                               : use.pull == Pull::kDown ? GPIOD_LINE_BIAS_PULL_DOWN
                                                                         : GPIOD_LINE_BIAS_AS_IS);
  return settings;
}

gpiod_line_value value_of(bool active) {
  return active ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE;
}

Settings output_settings(const LineUse& use, bool active) {
  Settings settings(gpiod_line_settings_new(), gpiod_line_settings_free);
  if (!settings) return settings;
  gpiod_line_settings_set_direction(settings.get(), GPIOD_LINE_DIRECTION_OUTPUT);
  gpiod_line_settings_set_active_low(settings.get(), use.active_low);
  gpiod_line_settings_set_output_value(settings.get(), value_of(active));
  return settings;
}

/// Collects the lines of a request, then asks for them.
class Asking {
 public:
  Asking(const std::string& path, const std::string& who) : path_(path), who_(who) {}

  void add(unsigned offset, const Settings& settings) {
    first_ = added_++ == 0 ? offset : first_;
    const bool known = settings && lines_ &&
                       gpiod_line_config_add_line_settings(lines_.get(), &offset, 1, settings.get()) == 0;
    if (!known) throw line_error(who_, path_, offset, errno);
  }

  Request ask() {
    const Chip chip = open_chip(path_, who_);
    const RequestConfig config(gpiod_request_config_new(), gpiod_request_config_free);
    if (config) gpiod_request_config_set_consumer(config.get(), ("dynslam " + who_).c_str());
    Request request(gpiod_chip_request_lines(chip.get(), config.get(), lines_.get()),
                    gpiod_line_request_release);
    if (!request) throw line_error(who_, path_, first_, errno);
    return request;
  }

 private:
  const std::string& path_;
  const std::string& who_;
  LineConfig lines_{gpiod_line_config_new(), gpiod_line_config_free};
  unsigned first_ = 0, added_ = 0;
};

class Inputs : public InputLines {
 public:
  Inputs(const std::string& path, std::span<const LineUse> uses, const std::string& who)
      : path_(path), who_(who), values_(uses.size()) {
    Asking asking(path, who);
    for (const LineUse& use : uses) {
      asking.add(use.offset, input_settings(use));
      offsets_.push_back(use.offset);
    }
    request_ = asking.ask();
    if (!edges_) throw chip_error(who, path, ENOMEM);
  }

  void read(std::span<bool> active) override {
    if (gpiod_line_request_get_values_subset(request_.get(), offsets_.size(), offsets_.data(),
                                             values_.data()) < 0)
      fail();
    std::transform(values_.begin(), values_.end(), active.begin(),
                   [](gpiod_line_value v) { return v == GPIOD_LINE_VALUE_ACTIVE; });
  }

  std::size_t take_edges(std::span<LineEdge> edges, Clock::SteadyTime until) override {
    const std::chrono::nanoseconds left = until - std::chrono::steady_clock::now();
    const int ready =
        gpiod_line_request_wait_edge_events(request_.get(), std::max<std::int64_t>(left.count(), 0));
    if (ready < 0 && errno != EINTR) fail();
    if (ready <= 0) return 0;
    const int count = gpiod_line_request_read_edge_events(request_.get(), edges_.get(),
                                                          std::min(edges.size(), kEdgesAtOnce));
    if (count < 0) fail();
    std::size_t taken = 0;
    for (unsigned i = 0; i < static_cast<unsigned>(count); ++i)
      edges[taken++] = edge_of(gpiod_edge_event_buffer_get_event(edges_.get(), i));
    return taken;
  }

 private:
  LineEdge edge_of(gpiod_edge_event* event) const {
    const unsigned offset = gpiod_edge_event_get_line_offset(event);
    const auto index = std::find(offsets_.begin(), offsets_.end(), offset) - offsets_.begin();
    const std::chrono::nanoseconds at(gpiod_edge_event_get_timestamp_ns(event));
    return {static_cast<std::size_t>(index),
            gpiod_edge_event_get_event_type(event) == GPIOD_EDGE_EVENT_RISING_EDGE, Clock::SteadyTime(at)};
  }

  [[noreturn]] void fail() const {
    const int error = errno;
    throw line_error(who_, path_, offsets_.front(), error);
  }

  std::string path_, who_;
  std::vector<unsigned> offsets_;
  std::vector<gpiod_line_value> values_;
  Request request_{nullptr, gpiod_line_request_release};
  Edges edges_{gpiod_edge_event_buffer_new(kEdgesAtOnce), gpiod_edge_event_buffer_free};
};

class Output : public OutputLine {
 public:
  Output(const std::string& path, const LineUse& use, bool active, const std::string& who)
      : path_(path), who_(who), offset_(use.offset) {
    Asking asking(path, who);
    asking.add(use.offset, output_settings(use, active));
    request_ = asking.ask();
  }

  void set(bool active) override {
    if (gpiod_line_request_set_value(request_.get(), offset_, value_of(active)) < 0)
      throw line_error(who_, path_, offset_, errno);
  }

 private:
  std::string path_, who_;
  unsigned offset_;
  Request request_{nullptr, gpiod_line_request_release};
};

}  // namespace

ChipInfo ask_chip(const std::string& path) {
  const Chip chip(gpiod_chip_open(path.c_str()), gpiod_chip_close);
  if (!chip) return {path, {}, 0, errno};
  const Info info(gpiod_chip_get_info(chip.get()), gpiod_chip_info_free);
  if (!info) return {path, {}, 0, errno};
  return {path, gpiod_chip_info_get_label(info.get()), gpiod_chip_info_get_num_lines(info.get())};
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
