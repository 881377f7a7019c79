// SPDX-License-Identifier: MIT
#include "drivers/emulated_gpio_chip.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <iterator>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <linux/gpio.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

namespace dynslam {
namespace {

constexpr unsigned kHolders = 8;  ///< at once

void add_device(UMockdevTestbed* bed, const std::string& name, int minor) {
  const std::string text = "P: /devices/platform/" + name + "\nN: " + name + "\nE: DEVNAME=/dev/" + name +
                           "\nE: SUBSYSTEM=gpio\nE: MAJOR=254\nE: MINOR=" + std::to_string(minor) +
                           "\nA: dev=254:" + std::to_string(minor) + "\\n\n";
  GError* error = nullptr;
  if (umockdev_testbed_add_from_string(bed, text.c_str(), &error) == 0)
    throw std::runtime_error(error->message);
}

template <std::size_t N>
void copy_text(char (&to)[N], const std::string& text) {
  std::memset(to, 0, N);
  std::memcpy(to, text.data(), std::min(text.size(), N - 1));
}

std::uint64_t monotonic_ns() {
  return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
}

std::uint64_t flags_of(const gpio_v2_line_config& config, unsigned i) {
  for (unsigned k = 0; k < config.num_attrs; ++k) {
    const gpio_v2_line_config_attribute& a = config.attrs[k];
    if (a.attr.id == GPIO_V2_LINE_ATTR_ID_FLAGS && ((a.mask >> i) & 1U) != 0) return a.attr.flags;
  }
  return config.flags;
}

bool output_of(const gpio_v2_line_config& config, unsigned i) {
  for (unsigned k = 0; k < config.num_attrs; ++k) {
    const gpio_v2_line_config_attribute& a = config.attrs[k];
    if (a.attr.id == GPIO_V2_LINE_ATTR_ID_OUTPUT_VALUES && ((a.mask >> i) & 1U) != 0)
      return ((a.attr.values >> i) & 1U) != 0;
  }
  return false;
}

}  // namespace

EmulatedGpioChip::EmulatedGpioChip(UMockdevTestbed* bed, unsigned number, const std::string& label,
                                   unsigned lines)
    : bed_(bed),
      calls_(umockdev_ioctl_base_new()),
      path_("/dev/gpiochip" + std::to_string(number)),
      label_(label),
      lines_(lines) {
  g_signal_connect(calls_, "handle-ioctl", G_CALLBACK(on_call), this);
  const auto add = [&](const std::string& name, unsigned minor) {
    add_device(bed_, name, static_cast<int>(minor));
    umockdev_testbed_attach_ioctl(bed_, ("/dev/" + name).c_str(), calls_, nullptr);
  };
  add(path_.substr(5), number);
  for (unsigned i = 0; i < kHolders; ++i)
    add("gpioline" + std::to_string(number) + "." + std::to_string(i), 100 + 10 * number + i);
}

EmulatedGpioChip::~EmulatedGpioChip() {
  umockdev_testbed_detach_ioctl(bed_, path_.c_str(), nullptr);
  for (auto& [node, held] : held_) close(held.fd);
  g_object_unref(calls_);
}

void EmulatedGpioChip::set_wire(unsigned line, bool high) {
  const std::lock_guard lock(mutex_);
  if (lines_.at(line).high == high) return;
  lines_[line].high = high;
  for (auto& [node, held] : held_) {
    for (const unsigned l : held.lines) {
      if (l == line && held.edges && !lose_edges_) send_edge(held, line);
    }
  }
}

bool EmulatedGpioChip::wire(unsigned line) const {
  const std::lock_guard lock(mutex_);
  return lines_.at(line).high;
}

std::optional<std::string> EmulatedGpioChip::consumer(unsigned line) const {
  const std::lock_guard lock(mutex_);
  const Held* const held = holder(line);
  return held ? std::optional(held->consumer) : std::nullopt;
}

bool EmulatedGpioChip::pulled_up(unsigned line) const {
  const std::lock_guard lock(mutex_);
  return lines_.at(line).pull_up;
}

void EmulatedGpioChip::lose_edges(bool lose) {
  const std::lock_guard lock(mutex_);
  lose_edges_ = lose;
}

void EmulatedGpioChip::fail_with(int error) {
  const std::lock_guard lock(mutex_);
  error_ = error;
}

gboolean EmulatedGpioChip::on_call(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer chip) {
  static_cast<EmulatedGpioChip*>(chip)->answer(client);
  return TRUE;
}

void EmulatedGpioChip::answer(UMockdevIoctlClient* client) {
  const unsigned long request = umockdev_ioctl_client_get_request(client);
  UMockdevIoctlData* const argument = umockdev_ioctl_client_get_arg(client);
  UMockdevIoctlData* const data = umockdev_ioctl_data_resolve(argument, 0, _IOC_SIZE(request), nullptr);
  int error = EFAULT;
  if (data) {
    const std::lock_guard lock(mutex_);
    const std::string node = umockdev_ioctl_client_get_devnode(client);
    const auto held = held_.find(node);
    error = error_ != 0           ? error_
            : node == path_       ? answer_chip(request, data->data)
            : held != held_.end() ? answer_lines(held->second, request, data->data)
                                  : EBADF;
    g_object_unref(data);
  }
  umockdev_ioctl_client_complete(client, error == 0 ? 0 : -1, error);
}

int EmulatedGpioChip::answer_chip(unsigned long request, std::uint8_t* data) {
  forget_who_left();
  switch (request) {
    case GPIO_GET_CHIPINFO_IOCTL: {
      gpiochip_info info{};
      copy_text(info.name, path_.substr(5));
      copy_text(info.label, label_);
      info.lines = static_cast<std::uint32_t>(lines_.size());
      std::memcpy(data, &info, sizeof info);
      return 0;
    }
    case GPIO_GET_LINEINFO_IOCTL:
      return tell_line(data);
    case GPIO_GET_LINEHANDLE_IOCTL:
      return give_handle(data);
    case GPIO_GET_LINEEVENT_IOCTL:
      return give_events(data);
    case GPIO_V2_GET_LINE_IOCTL:
      return give_version_2(data);
    default:
      return ENOTTY;
  }
}

int EmulatedGpioChip::tell_line(std::uint8_t* data) const {
  gpioline_info info;
  std::memcpy(&info, data, sizeof info);
  if (info.line_offset >= lines_.size()) return EINVAL;
  const Held* const held = holder(info.line_offset);
  info.flags = held ? GPIOLINE_FLAG_KERNEL : 0;
  copy_text(info.consumer, held ? held->consumer : "");
  copy_text(info.name, "GPIO" + std::to_string(info.line_offset));
  std::memcpy(data, &info, sizeof info);
  return 0;
}

int EmulatedGpioChip::give_handle(std::uint8_t* data) {
  gpiohandle_request request;
  std::memcpy(&request, data, sizeof request);
  const bool output = (request.flags & GPIOHANDLE_REQUEST_OUTPUT) != 0;
  Held held{{request.lineoffsets, request.lineoffsets + request.lines}, request.consumer_label};
  const int fd = give(std::move(held));
  if (fd < 0) return -fd;
  for (unsigned i = 0; i < request.lines; ++i) {
    Line& line = lines_[request.lineoffsets[i]];
    line.active_low = (request.flags & GPIOHANDLE_REQUEST_ACTIVE_LOW) != 0;
    line.output = output;
    if (output) drive(request.lineoffsets[i], request.default_values[i] != 0);
  }
  request.fd = fd;
  std::memcpy(data, &request, sizeof request);
  return 0;
}

int EmulatedGpioChip::give_events(std::uint8_t* data) {
  gpioevent_request request;
  std::memcpy(&request, data, sizeof request);
  Held held{{request.lineoffset}, request.consumer_label};
  held.edges = true;
  const int fd = give(std::move(held));
  if (fd < 0) return -fd;
  Line& line = lines_[request.lineoffset];
  line.active_low = (request.handleflags & GPIOHANDLE_REQUEST_ACTIVE_LOW) != 0;
  line.pull_up = (request.handleflags & GPIOHANDLE_REQUEST_BIAS_PULL_UP) != 0;
  request.fd = fd;
  std::memcpy(data, &request, sizeof request);
  return 0;
}

int EmulatedGpioChip::give_version_2(std::uint8_t* data) {
  gpio_v2_line_request request;
  std::memcpy(&request, data, sizeof request);
  Held held{{request.offsets, request.offsets + request.num_lines}, request.consumer};
  held.version_2 = true;
  held.edges = (flags_of(request.config, 0) & GPIO_V2_LINE_FLAG_EDGE_RISING) != 0;
  const int fd = give(std::move(held));
  if (fd < 0) return -fd;
  for (unsigned i = 0; i < request.num_lines; ++i) {
    const std::uint64_t flags = flags_of(request.config, i);
    Line& line = lines_[request.offsets[i]];
    line.active_low = (flags & GPIO_V2_LINE_FLAG_ACTIVE_LOW) != 0;
    line.pull_up = (flags & GPIO_V2_LINE_FLAG_BIAS_PULL_UP) != 0;
    line.output = (flags & GPIO_V2_LINE_FLAG_OUTPUT) != 0;
    if (line.output) drive(request.offsets[i], output_of(request.config, i));
  }
  request.fd = fd;
  std::memcpy(data, &request, sizeof request);
  return 0;
}

/// Calls on the descriptor are seen as it is one of a mocked node; what is read from it comes from here. A
/// stream gives as many events to a reader as it has room for, as the kernel does.
int EmulatedGpioChip::give(Held held) {
  for (const unsigned line : held.lines) {
    if (line >= lines_.size()) return -EINVAL;
    if (holder(line)) return -EBUSY;
  }
  for (unsigned i = 0; i < kHolders; ++i) {
    const std::string node = "/dev/gpioline" + path_.substr(13) + "." + std::to_string(i);
    if (held_.contains(node)) continue;
    int ends[2];
    const int fd = open(node.c_str(), O_RDWR | O_CLOEXEC);
    if (fd < 0 || socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return -EIO;
    dup2(ends[0], fd);
    close(ends[0]);
    held.fd = ends[1];
    held_.emplace(node, std::move(held));
    return fd;
  }
  return -ENOMEM;
}

void EmulatedGpioChip::forget_who_left() {
  for (auto it = held_.begin(); it != held_.end();) {
    pollfd p{it->second.fd, POLLIN, 0};
    const bool left = poll(&p, 1, 0) > 0 && (p.revents & POLLHUP) != 0;
    if (left) close(it->second.fd);
    it = left ? held_.erase(it) : std::next(it);
  }
}

const EmulatedGpioChip::Held* EmulatedGpioChip::holder(unsigned line) const {
  for (const auto& [node, held] : held_) {
    pollfd p{held.fd, POLLIN, 0};
    if (poll(&p, 1, 0) > 0 && (p.revents & POLLHUP) != 0) continue;
    for (const unsigned l : held.lines) {
      if (l == line) return &held;
    }
  }
  return nullptr;
}

int EmulatedGpioChip::answer_lines(Held& held, unsigned long request, std::uint8_t* data) {
  gpiohandle_data values;
  gpio_v2_line_values bits;
  switch (request) {
    case GPIOHANDLE_GET_LINE_VALUES_IOCTL:
      for (std::size_t i = 0; i < held.lines.size(); ++i) data[i] = active(held.lines[i]) ? 1 : 0;
      return 0;
    case GPIOHANDLE_SET_LINE_VALUES_IOCTL:
      std::memcpy(&values, data, sizeof values);
      for (std::size_t i = 0; i < held.lines.size(); ++i) drive(held.lines[i], values.values[i] != 0);
      return 0;
    case GPIO_V2_LINE_GET_VALUES_IOCTL:
      std::memcpy(&bits, data, sizeof bits);
      bits.bits = 0;
      for (std::size_t i = 0; i < held.lines.size(); ++i)
        bits.bits |= std::uint64_t{active(held.lines[i])} << i;
      std::memcpy(data, &bits, sizeof bits);
      return 0;
    case GPIO_V2_LINE_SET_VALUES_IOCTL:
      std::memcpy(&bits, data, sizeof bits);
      for (std::size_t i = 0; i < held.lines.size(); ++i) {
        if (((bits.mask >> i) & 1U) != 0) drive(held.lines[i], ((bits.bits >> i) & 1U) != 0);
      }
      return 0;
    default:
      return ENOTTY;
  }
}

void EmulatedGpioChip::send_edge(Held& held, unsigned line) {
  constexpr int kDropWhenFull = MSG_DONTWAIT | MSG_NOSIGNAL;
  const bool rising = active(line);
  if (held.version_2) {
    gpio_v2_line_event event{};
    event.timestamp_ns = monotonic_ns();
    event.id = rising ? GPIO_V2_LINE_EVENT_RISING_EDGE : GPIO_V2_LINE_EVENT_FALLING_EDGE;
    event.offset = line;
    event.seqno = event.line_seqno = ++held.sequence;
    send(held.fd, &event, sizeof event, kDropWhenFull);
  } else {
    gpioevent_data event{};
    event.timestamp = monotonic_ns();
    event.id = rising ? GPIOEVENT_EVENT_RISING_EDGE : GPIOEVENT_EVENT_FALLING_EDGE;
    send(held.fd, &event, sizeof event, kDropWhenFull);
  }
}

}  // namespace dynslam
