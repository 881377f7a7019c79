// SPDX-License-Identifier: MIT
#include "tools/jitter/jitter_runs.h"

#include <atomic>
#include <exception>
#include <future>
#include <thread>
#include <utility>

#include "base/error.h"
#include "robot/replay.h"
#include "tools/jitter/trajectory_error.h"

namespace dynslam::jitter {
namespace {

CopyResult run_copy(const OpenRecording& open, const std::vector<StampedPose>& reference,
                    const JitterPlan& plan, std::optional<std::uint64_t> seed) {
  std::unique_ptr<Recording> recording = open();
  if (seed) recording = std::make_unique<JitteredRecording>(std::move(recording), plan.jitter, *seed);
  MappingResult replayed = replay(*recording, plan.slam, [](double, std::uint64_t) {});
  if (recording->damage()) throw InputError(*recording->damage());
  if (replayed.inserted == 0) throw InputError("the recording holds no usable scan of a lidar");
  const double final_m = absolute_error_m(replayed.trajectory, reference);
  return {seed,
          replayed.trajectory.size(),
          final_m,
          absolute_error_m(replayed.trajectory_live, reference),
          replayed.loop_closures,
          std::move(replayed.trajectory)};
}

}  // namespace

std::vector<CopyResult> run_copies(const OpenRecording& open, const std::vector<StampedPose>& reference,
                                   const JitterPlan& plan,
                                   const std::function<void(const CopyResult&)>& tell) {
  const std::size_t runs = static_cast<std::size_t>(plan.copies) + 1;
  std::vector<std::promise<CopyResult>> promises(runs);
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < runs; i = next++) {
      try {
        const auto seed = i == 0 ? std::nullopt : std::optional(plan.seed + i - 1);
        promises[i].set_value(run_copy(open, reference, plan, seed));
      } catch (...) {
        next = runs;  // no use in beginning another
        promises[i].set_exception(std::current_exception());
      }
    }
  };
  std::vector<std::jthread> workers;
  workers.reserve(static_cast<std::size_t>(plan.jobs));
  for (int i = 0; i < plan.jobs; ++i) workers.emplace_back(work);

  std::vector<CopyResult> results;
  for (std::promise<CopyResult>& promise : promises) {
    results.push_back(promise.get_future().get());
    tell(results.back());
  }
  return results;
}

}  // namespace dynslam::jitter
