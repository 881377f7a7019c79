// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <umockdev.h>

namespace dynslam {

/// A chip of GPIO lines behind the kernel's character device, both versions of its calls, as far as libgpiod
/// asks for them. It needs the program to be linked with umockdev's preload library. Any thread.
class EmulatedGpioChip {
 public:
  /// The chip is /dev/gpiochip`number` in the test bed, which must outlive this.
  EmulatedGpioChip(UMockdevTestbed* bed, unsigned number, const std::string& label, unsigned lines);
  ~EmulatedGpioChip();
  EmulatedGpioChip(const EmulatedGpioChip&) = delete;
  EmulatedGpioChip& operator=(const EmulatedGpioChip&) = delete;

  /// Sets the level of a line's wire; who holds the line hears of it when it changes.
  void set_wire(unsigned line, bool high);
  /// The level that is there: an output's is what it drives.
  bool wire(unsigned line) const;
  /// Who holds the line; nothing when it is free.
  std::optional<std::string> consumer(unsigned line) const;
  bool pulled_up(unsigned line) const;
  /// From now on nobody hears of edges.
  void lose_edges(bool lose);
  /// From now on every call on chip and lines gives this errno; 0: none.
  void fail_with(int error);

 private:
  struct Line {
    bool high = false, active_low = false, output = false, pull_up = false;
  };
  /// Lines that somebody holds; the other end of its descriptor is here.
  struct Held {
    std::vector<unsigned> lines;
    std::string consumer;
    int fd = -1;
    bool edges = false, version_2 = false;
    std::uint32_t sequence = 0;
  };

  static gboolean on_call(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer chip);
  void answer(UMockdevIoctlClient* client);
  int answer_chip(unsigned long request, std::uint8_t* data);
  int answer_lines(Held& held, unsigned long request, std::uint8_t* data);
  int tell_line(std::uint8_t* data) const;
  int give_handle(std::uint8_t* data);
  int give_events(std::uint8_t* data);
  int give_version_2(std::uint8_t* data);
  /// The descriptor of a new holder, or what is wrong, negative.
  int give(Held held);
  void forget_who_left();
  const Held* holder(unsigned line) const;
  bool active(unsigned line) const { return lines_[line].high != lines_[line].active_low; }
  void drive(unsigned line, bool active) { lines_[line].high = active != lines_[line].active_low; }
  void send_edge(Held& held, unsigned line);

  UMockdevTestbed* bed_;
  UMockdevIoctlBase* calls_;
  std::string path_, label_;
  mutable std::mutex mutex_;
  std::vector<Line> lines_;
  std::map<std::string, Held> held_;  ///< by the node of its descriptor
  bool lose_edges_ = false;
  int error_ = 0;
};

}  // namespace dynslam
