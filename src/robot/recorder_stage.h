// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "base/wall_time.h"
#include "io/mcap_file.h"
#include "io/recording_folder.h"
#include "robot/event_writer.h"
#include "robot/recorder_config.h"

namespace dynslam {

/// What recordings say of the program that made them.
struct RecordingAbout {
  std::string library = "dynslam";            ///< name and version
  std::map<std::string, std::string> fields;  ///< among them `config`, as JSON without secrets
};

/// Writes all that the robot senses, decides and is told into MCAP files: when Ports::recording_wish says so,
/// else, if configured, always into a ring of files of which the oldest go. A chunk is written twice a
/// second, so that whatever ends the program takes the last second at most with it. A disk that is full or
/// does not write ends the recording, not the robot; the ring tries again now and then.
///
/// One thread; add() is for any, never waits, and does next to nothing while nothing is recorded.
class RecorderStage {
 public:
  /// `clock` and `ports` must outlive it.
  RecorderStage(const RecorderConfig& config, RecordingAbout about, const Clock& clock, Ports& ports);
  ~RecorderStage() { finish(); }
  RecorderStage(const RecorderStage&) = delete;
  RecorderStage& operator=(const RecorderStage&) = delete;

  bool active() const { return active_.load(std::memory_order_relaxed); }

  bool wants_pictures() const { return config_.camera && active(); }
  std::uint64_t dropped() const { return events_.dropped(); }

  /// Takes what RecorderEvent can hold. Of what comes faster than it can be written the oldest goes, counted.
  template <class T>
  void add(T what) {
    if (active()) events_.push({clock_.now(), std::move(what)});
  }

  /// The clock runs by itself: files are put on the disk every few seconds and say the date. Without this the
  /// same events give the same bytes.
  void run_live(std::function<WallTime()> wall = wall_now) { wall_ = std::move(wall); }

  /// Waits a moment for events and writes them; begins and ends recordings as wished.
  void turn();
  /// Nobody waits any more.
  void close();
  /// Writes what is under way and ends the recording. Nothing is recorded after it.
  void finish();

  static constexpr std::size_t kQueue = 256;

 private:
  /// A file in work and who fills it.
  struct Run {
    Run(std::string path, std::uint64_t floor, const RecordingAbout& about, Ports& ports, Time now);
    McapFile file;
    EventWriter events;
    Time begun, chunk_begun, sync_due;
  };
  void follow_wish(Time now);
  bool may_begin(Time now) const;
  void begin(Time now);
  std::string next_path(Time now);
  RecordingAbout about_at(Time now) const;
  void write_events(Time now);
  void keep_whole(Time now);
  void keep_small(Time now);
  void end(const std::string& trouble);
  void give_up(const std::string& trouble);
  void publish(Time now);

  RecorderConfig config_;
  RecordingAbout about_;
  const Clock& clock_;
  Ports& ports_;
  RecordingFolder folder_;
  BoundedQueue<RecorderEvent> events_{kQueue};
  std::atomic<bool> active_{false};
  std::function<WallTime()> wall_;  ///< empty: the clock does not run by itself
  bool closed_ = false;
  std::uint64_t wish_seen_ = 0;
  std::optional<RecordingWish> asked_;  ///< what is recorded because somebody wants it
  Time ring_again_;                     ///< when a ring that could not be written is tried once more
  std::unique_ptr<Run> run_;            ///< null: nothing is recorded
  std::unique_ptr<Run> retiring_;       ///< the ring's file before it, while it is put on the disk
  RecordingState state_;
  Time publish_due_;
};

}  // namespace dynslam
