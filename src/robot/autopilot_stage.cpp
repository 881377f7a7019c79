// SPDX-License-Identifier: MIT
#include "robot/autopilot_stage.h"

#include <algorithm>
#include <utility>

namespace dynslam {
namespace {

/// What was planned longer ago than this is not driven: something hangs.
constexpr Duration kPlanHolds = std::chrono::seconds(3);
/// Older poses are not carried on.
constexpr Duration kPoseHolds = std::chrono::milliseconds(800);
/// Turns are measured over so long.
constexpr Duration kTurnOver = std::chrono::milliseconds(100);

}  // namespace

AutopilotStage::AutopilotStage(const AutopilotSetup& setup, const DriveConfig& drive, const Clock& clock,
                               Ports& ports, const Latest<ImuSample>& imu)
    : clock_(clock),
      ports_(ports),
      imu_(imu),
      autopilot_(setup),
      plan_due_(clock.now()),
      follower_(drive.follower, drive.body, drive.clearance),
      pilot_due_(clock.now()) {}

void AutopilotStage::plan_turn() {
  const Time now = clock_.now();
  std::vector<Order> orders;
  while (auto order = ports_.orders.try_pop()) orders.push_back(std::move(*order));
  AutopilotInputs in;
  in.orders = orders;
  in.world = ports_.world.get().value;
  in.notes = ports_.map_notes.get().value;
  if (const auto report = report_.get().value) in.follow = *report;
  in.condition = condition(in.world);
  if (const auto came = came_.get().value) in.came = *came;
  // Who orders anew knows of what was before.
  const auto interruption = interruption_.get().value;
  if (interruption && interruption->errand == errand_ && orders.empty()) {
    in.is_steered = interruption->is_steered;
    if (!in.is_steered) in.condition = interruption->condition;
  }
  const auto glass = glass_map_.get().value;
  if (glass) in.glass_map = *glass;
  const AutopilotStatus& status = autopilot_.turn(now, in);
  errand_ = status.errand;
  wanted_.put({now, status.errand, status.phase == AutopilotPhase::kActive, autopilot_.task(),
               autopilot_.look_round_radps(), autopilot_.backs_off()});
  ports_.autopilot.put(status);
  plan_due_ = std::max(plan_due_ + kPlanEvery, now);
}

Condition AutopilotStage::condition(const std::shared_ptr<const WorldState>& world) const {
  Condition c;
  if (world) c.pose = world->pose;
  if (const auto drive = ports_.drive.get().value) {
    c.verdict = drive->verdict;
    c.cause = drive->cause;
    c.battery = drive->battery.level;
    c.touches = drive->collision.value_or(false);
  }
  return c;
}

void AutopilotStage::pilot_turn() {
  const Time now = clock_.now();
  pilot_due_ = std::max(pilot_due_ + kCommandEvery, now);
  const auto wanted = wanted_.get();
  feel(now);
  if (!wanted.value || !wanted.value->drives || now - wanted.value->time > kPlanHolds) return let_go();
  mind_interruptions(wanted.value->errand);
  // The planning turn is told, but may take its time: no word more until there is another errand.
  if (interrupted_ == wanted.value->errand) return let_go();
  follow(wanted.value->backs_off ? std::nullopt : wanted.value->task);
  if (!wanted.value->backs_off) {
    if (!touches_) back_off_.note(applied_);
    came_.put(back_off_.came());
  }
  const Twist twist = wanted_twist(now, *wanted.value);
  command(now, twist, false);
}

/// Only what is new: the follower's patience begins anew with each route.
void AutopilotStage::follow(const std::optional<DriveTask>& task) {
  if (task == followed_) return;
  followed_ = task;
  if (task) {
    follower_.follow(*task);
  } else {
    follower_.halt();
  }
}

/// Somebody else commanded since, and to move.
bool AutopilotStage::is_steered_by_others() const {
  const auto last = ports_.command.get().value;
  if (!sent_ || !last) return false;
  return last->heard >= sent_->heard && last->seq != sent_->seq && is_moving(last->twist);
}

/// A stop may be cleared before the next plan.
void AutopilotStage::mind_interruptions(std::uint64_t errand) {
  Interruption interruption{errand, is_steered_by_others(), condition(world_)};
  const auto hindrance = hindrance_of(interruption.condition);
  const bool is_over = hindrance && hindrance->remedy == Hindrance::Remedy::kGiveUp;
  if (!interruption.is_steered && !is_over) return;
  interrupted_ = errand;
  interruption_.put(std::move(interruption));
}

/// Leaves the wheel to whoever takes it.
void AutopilotStage::let_go() {
  follow(std::nullopt);
  if (sent_) command(clock_.now(), {}, true);
  sent_.reset();
}

/// How the robot moves, from all that tells of it.
void AutopilotStage::feel(Time now) {
  const auto drive = ports_.drive.get().value;
  const auto imu = imu_.get().value;
  applied_ = drive ? drive->applied : Twist{};
  touches_ = drive && drive->collision.value_or(false);
  follower_.feel(touches_);
  motion_.add(now, applied_, imu ? std::optional(*imu) : std::nullopt);
  measured_.w_radps = motion_.between(now - kTurnOver, now).yaw / to_seconds(kTurnOver);
  const auto world = ports_.world.get().value;
  if (world && world_ && world->pose.stamp > world_->pose.stamp) {
    const Pose2 moved = world_->pose.map_T_robot.inverse() * world->pose.map_T_robot;
    const double passed_s = to_seconds(world->pose.stamp - world_->pose.stamp);
    measured_.v_mps = moved.x / passed_s;
  }
  world_ = world;
  const auto scan = ports_.scan.get();
  if (!scan.value || scan.version == std::exchange(scan_version_, scan.version)) return;
  follower_.see(*scan.value, motion_);
  tell_of_glass(end_of(*scan.value));
}

void AutopilotStage::tell_of_glass(Time seen) {
  std::vector<Segment> panes = follower_.panes();
  if (!world_ || world_->pose.lost) panes.clear();
  if (!panes.empty()) {
    const Time known = world_->pose.stamp;
    const Pose2 since = seen < known ? motion_.between(seen, known).inverse() : motion_.between(known, seen);
    const Pose2 map_T_seen = world_->pose.map_T_robot * since;
    for (Segment& pane : panes) pane = {map_T_seen * pane.from, map_T_seen * pane.to};
  }
  glass_map_.put(std::move(panes));
}

Twist AutopilotStage::wanted_twist(Time now, const Wanted& wanted) {
  const auto drive = ports_.drive.get().value;
  // A driver whose command was cut off lets go before he pushes again.
  const bool is_stopped = !drive || drive->verdict.motion >= Motion::kStop;
  const bool has_pose = world_ && !world_->pose.lost && now - world_->pose.stamp < kPoseHolds;
  Twist twist;
  if (wanted.backs_off) {
    twist = back_off_.twist();
  } else if (wanted.look_round_radps != 0.0) {
    twist = {0.0, wanted.look_round_radps};
  } else if (wanted.task && has_pose && !is_stopped) {
    const Pose2 map_T_robot = world_->pose.map_T_robot * motion_.between(world_->pose.stamp, now);
    const FollowOutput out =
        follower_.next({now, map_T_robot, measured_, drive->verdict.motion == Motion::kHold}, motion_);
    report_.put({wanted.task->id, out.state, out.remaining_m, follower_.remaining(), out.reason});
    twist = speed_.correct(now, out.twist, applied_, measured_);
  }
  return is_stopped ? Twist{} : twist;
}

/// A number no smaller than any that another commander may have used meanwhile.
void AutopilotStage::command(Time now, const Twist& twist, bool gone) {
  if (is_steered_by_others()) return;  // since it was looked last
  const auto last = ports_.command.get().value;
  sent_ = DriveCommand{(last ? last->seq : 0) + 1, twist, now, gone};
  ports_.command.put(*sent_);
}

}  // namespace dynslam
