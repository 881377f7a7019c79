// SPDX-License-Identifier: MIT
#include "robot/recorder_stage.h"

#include <algorithm>
#include <exception>

namespace dynslam {
namespace {

constexpr Duration kIdle = std::chrono::milliseconds(100);
constexpr Duration kMoment = std::chrono::milliseconds(50);
constexpr Duration kChunk = std::chrono::milliseconds(500);
constexpr std::size_t kChunkBytes = 1 << 20;
constexpr Duration kSyncEvery = std::chrono::seconds(5);
constexpr Duration kRingFile = std::chrono::minutes(10);
constexpr Duration kRingAgain = std::chrono::seconds(10);
constexpr Duration kPublishEvery = std::chrono::seconds(1);

constexpr std::uint64_t mib(int n) { return static_cast<std::uint64_t>(n) << 20; }

}  // namespace

RecorderStage::Run::Run(std::string path, std::uint64_t floor, const RecordingAbout& about, Ports& ports,
                        Time now)
    : file(std::move(path), floor, about.library, about.fields),
      events(file.ros(), ports),
      begun(now),
      chunk_begun(now),
      sync_due(now + kSyncEvery) {}

RecorderStage::RecorderStage(const RecorderConfig& config, RecordingAbout about, const Clock& clock,
                             Ports& ports)
    : config_(config), about_(std::move(about)), clock_(clock), ports_(ports), folder_(config.folder) {}

void RecorderStage::turn() {
  const Time now = clock_.now();
  try {
    follow_wish(now);
    if (!run_ && may_begin(now)) begin(now);
    if (!run_) {
      ports_.recording_wish.wait(wish_seen_, clock_.steady(now + kIdle));
      return;
    }
    write_events(now);
    keep_whole(clock_.now());
    keep_small(clock_.now());
  } catch (const std::exception& e) {
    give_up(e.what());
  }
}

/// Whoever wants a recording that is being made already gets that one.
void RecorderStage::follow_wish(Time now) {
  const auto wish = ports_.recording_wish.get();
  if (wish.version == wish_seen_) return;
  wish_seen_ = wish.version;
  if (wish.value->on == asked_.has_value()) return;
  if (run_) end({});
  asked_ = wish.value->on ? std::optional(*wish.value) : std::nullopt;
  ring_again_ = now;
}

bool RecorderStage::may_begin(Time now) const {
  return !closed_ && (asked_ || (config_.always && now >= ring_again_));
}

void RecorderStage::begin(Time now) {
  if (!active()) {
    while (events_.try_pop()) {
    }
  }
  state_ = {false, asked_.has_value(), next_path(now), 0, 0, 0.0, events_.dropped(), {}};
  run_ = std::make_unique<Run>(state_.file, mib(config_.free_floor_mib), about_at(now), ports_, now);
  if (config_.camera) ++ports_.watchers;
  active_ = true;
  publish(now);
}

std::string RecorderStage::next_path(Time now) {
  if (!asked_) {
    folder_.shrink_ring(mib(std::max(0, config_.ring_mib - config_.file_mib)),
                        mib(config_.free_floor_mib + config_.file_mib));
    return folder_.next_in_ring();
  }
  if (!asked_->file.empty()) return asked_->file;
  const auto seconds = std::chrono::floor<std::chrono::seconds>(now.time_since_epoch());
  return wall_ ? folder_.new_dated_file(wall_()) : folder_.new_file(std::to_string(seconds.count()));
}

/// Stamps are by the robot's clock; this is how they lie on the wall.
RecordingAbout RecorderStage::about_at(Time now) const {
  RecordingAbout about = about_;
  about.fields["begun_robot_ns"] = std::to_string(now.time_since_epoch().count());
  if (wall_) about.fields["begun_utc"] = utc_text(wall_(), "%Y-%m-%dT%H:%M:%SZ");
  return about;
}

/// A queue at most, so that chunks are closed in time however fast events come.
void RecorderStage::write_events(Time now) {
  auto event = events_.pop(clock_.steady(now + kMoment));
  for (std::size_t i = 0; event && i < kQueue; ++i) {
    run_->events.write(*event);
    event = events_.try_pop();
  }
  if (event) run_->events.write(*event);
  run_->events.look(clock_.now());
}

void RecorderStage::keep_whole(Time now) {
  if (run_->file.waiting() >= kChunkBytes || now >= run_->chunk_begun + kChunk) {
    run_->file.close_chunk();
    run_->chunk_begun = now;
  }
  if (wall_ && now >= run_->sync_due) {
    run_->file.file().sync_soon();
    run_->sync_due = now + kSyncEvery;
  }
  if (retiring_ && !retiring_->file.file().syncing()) retiring_.reset();
  if (now >= publish_due_) publish(now);
}

void RecorderStage::keep_small(Time now) {
  const std::uint64_t size = run_->file.file().size();
  if (asked_) {
    if (size >= mib(config_.most_mib))
      give_up(state_.file + ": has become as large as a recording may (recorder.most_mib)");
  } else if (size >= mib(config_.file_mib) || now >= run_->begun + kRingFile) {
    run_->events.finish(now);
    const std::string trouble = run_->file.finish();
    if (!trouble.empty()) return give_up(trouble);
    if (config_.camera) --ports_.watchers;
    if (wall_) run_->file.file().sync_soon();
    retiring_ = std::move(run_);
    begin(now);
  }
}

/// Ends the file that is written; what was asked for stays on the disk for good.
void RecorderStage::end(const std::string& trouble) {
  active_ = false;
  if (config_.camera) --ports_.watchers;
  state_.trouble = trouble;
  const Time now = clock_.now();
  try {
    while (const auto event = events_.try_pop()) run_->events.write(*event);
    run_->events.finish(now);
    const std::string left_out = run_->file.finish();
    if (state_.trouble.empty()) state_.trouble = left_out;
    publish(now);
    if (asked_) run_->file.file().sync();
  } catch (const std::exception& e) {
    if (state_.trouble.empty()) state_.trouble = e.what();
  }
  publish(now);
  run_.reset();
}

/// A recording that was asked for is over then, until somebody asks anew.
void RecorderStage::give_up(const std::string& trouble) {
  if (run_) end(trouble);
  active_ = false;
  state_.trouble = trouble;
  asked_.reset();
  ring_again_ = clock_.now() + kRingAgain;
  publish(clock_.now());
}

void RecorderStage::publish(Time now) {
  publish_due_ = now + kPublishEvery;
  state_.active = active();
  state_.dropped = events_.dropped();
  if (run_) {
    state_.bytes = run_->file.file().size();
    state_.messages = run_->file.messages();
    state_.seconds = to_seconds(now - run_->begun);
  }
  ports_.recording.put(state_);
}

void RecorderStage::close() {
  events_.close();
  ports_.recording_wish.close();
}

void RecorderStage::finish() {
  closed_ = true;
  if (run_) end({});
  asked_.reset();
}

}  // namespace dynslam
