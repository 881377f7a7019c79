// SPDX-License-Identifier: MIT
#include "bench_command.h"

#include <cstdio>
#include <memory>
#include <utility>

#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include "bench_report.h"
#include "errand_scripts.h"
#include "progress_bar.h"
#include "robot/stage_clock.h"
#include "robot/steady_memory.h"
#include "server/state_json.h"
#include "server/watch_channels.h"
#include "server/wire_bytes.h"
#include "sim/camera_picture.h"
#include "sim_mission.h"

namespace dynslam {
namespace {

constexpr Duration kStep = std::chrono::milliseconds(10);
/// Drawing one takes the simulator longer than all else.
constexpr Duration kPictureEvery = std::chrono::seconds(1);

/// One client's sockets of state and map, up to where bytes would go out.
class WatchingClient {
 public:
  WatchingClient(const Ports& ports, const Clock& clock)
      : clock_(clock),
        state_feed_(ports, [&ports, &clock] { return state_json(ports, extras(ports, clock)).dump(); }),
        map_feed_(ports, clock, kMapId) {
    std::string has_nothing;  // web/wire.md
    append_le(has_nothing, std::uint32_t{1});
    append_le(has_nothing, std::uint32_t{0});
    append_le(has_nothing, std::uint64_t{0});
    map_.take({WsOpcode::kBinary, has_nothing}, now());
  }

  /// Returns whether there was something to send.
  bool turn() {
    const std::size_t before = bytes_;
    for (Channel* channel : {static_cast<Channel*>(&state_), static_cast<Channel*>(&map_)}) {
      if (const auto message = channel->next(now()))
        bytes_ += ws_frame(message->opcode, message->payload).size();
    }
    return bytes_ > before;
  }
  std::size_t bytes() const { return bytes_; }

 private:
  static constexpr std::uint64_t kMapId = 1;
  static StateExtras extras(const Ports& ports, const Clock& clock) {
    return {clock.now(), ports.scan.get().version, {}, {}, {}, 0};
  }
  Channel::SteadyTime now() const { return Channel::SteadyTime(clock_.now().time_since_epoch()); }

  const Clock& clock_;
  StateFeed state_feed_;
  MapFeed map_feed_;
  StateChannel state_{state_feed_, {}};
  MapChannel map_{map_feed_, {}};
  std::size_t bytes_ = 0;
};

/// The camera's part while somebody watches it.
void take_picture(Simulator& simulator, CameraPicture& camera, WorkMeter& meter, Time now) {
  const auto view = simulator.next_view(now);
  if (!view) return;
  const Picture& picture = camera.draw(*view);
  meter.begin(Work::kPicturing);
  encode_jpeg(picture);
  meter.count(Work::kPicturing);
  meter.rest();
}

long peak_rss_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss * 1024L;
}

}  // namespace

int run_bench(const BenchOptions& options, const Config& config) {
  keep_memory_steady();
  Config own = config;
  own.recorder.always = false;
  SteppedClock clock;
  WorkMeter meter;
  const WorkTimer timer;
  SimMission mission({load_world(options.world), options.seed, options.duration_s, false, &meter},
                     std::make_unique<ExploreScript>(), own, clock);
  WatchingClient client(mission.robot().ports(), clock);
  CameraPicture camera(mission.simulator().world());
  {
    ProgressBar bar(true);
    Time picture_due;
    while (true) {
      clock.set(clock.now() + kStep);
      if (mission.turn()) break;
      mission.simulator().truth();  // what it has to do for this step is done here, and not when it is asked
      mission.robot().step();
      meter.begin(Work::kServing);
      if (client.turn()) meter.count(Work::kServing);
      meter.rest();
      if (clock.now() >= picture_due) {
        picture_due += kPictureEvery;
        take_picture(mission.simulator(), camera, meter, clock.now());
      }
      bar.show(mission.passed_s() / mission.limit_s(), mission.scans());
    }
  }
  BenchFigures figures{DYNSLAM_VERSION, options.world, options.seed, this_machine()};
  figures.drive_s = mission.passed_s();
  figures.driven_m = mission.simulator().truth().distance_m;
  figures.scans = mission.scans();
  figures.costs = meter.costs();
  figures.simulator_s = timer.cpu_s();
  for (const WorkCost& cost : figures.costs) figures.simulator_s -= 1e-3 * cost.total_ms();
  figures.client_bytes = client.bytes();
  figures.peak_rss_bytes = peak_rss_bytes();
  std::printf("%s\n%s\n", bench_table(figures).c_str(), bench_line(figures).c_str());
  return 0;
}

}  // namespace dynslam
