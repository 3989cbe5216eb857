// The motion supervisor's parked program: what was held is set aside, and queued again from its place.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "gateway/cycle/motion_supervisor.hpp"
#include "rmac/motion/move_name.hpp"
#include "rmac/motion/vector.hpp"

namespace rmac::gateway {
namespace {

/// The tool may stand this far from the place where a program goes on: what a part that is found to lie a little
/// elsewhere moves it by. A longer way back is the operator's, who sees what is in it.
constexpr double kWayBack_mm = 1;
constexpr double kWayBack_axis = 0.02;
/// Joints at the end of that way and at the begin of the path: mm or degrees.
constexpr double kSameJoints = 1e-5;
constexpr double kSlowest_mm_s = 1;

struct Place {
  ToolPose pose;
  std::vector<double> joints;
};

/// Where what was built begins: at `ahead`'s end when nothing is left of it.
Place begin_of(const PathSegments& built, const PathBuilder& ahead) {
  JointPoint point;
  if (built.empty() || built.front()->evaluate(0, 0, 1, point) != KinematicsStatus::Ok) {
    return {ahead.end_pose(), {ahead.end_joints().begin(), ahead.end_joints().end()}};
  }
  const auto count = static_cast<std::ptrdiff_t>(built.front()->joint_count());
  return {built.front()->pose(0), {point.d[0].begin(), point.d[0].begin() + count}};
}

Move way_to(const Move& like, Geometry geometry) {
  Move move = like;
  move.id = kPositioningMoveId;
  move.geometry = std::move(geometry);
  move.feed_mm_s = std::max(like.feed_mm_s, kSlowest_mm_s);
  return move;
}

tl::unexpected<Error> too_far(const ToolPose& stands, const ToolPose& place) {
  return failure(
      MinorCode::Other,
      fmt::format(
          "TakeUpProgram: the tool stands {:.3f} mm from where the program goes on, {:.4f}, {:.4f}, {:.4f} with "
          "the tool axis {:.4f}, {:.4f}, {:.4f} (part frame), and at most {} mm are made up for; move it there "
          "first",
          distance(stands.tip, place.tip), place.tip[0], place.tip[1], place.tip[2], place.axis[0], place.axis[1],
          place.axis[2], kWayBack_mm));
}

}  // namespace

Expected<> MotionSupervisor::park(std::uint64_t outputs_off) {
  const Turn turn(*this);
  notice_fault();
  const auto refuse = [](std::string why) { return failure(MinorCode::Other, "ParkProgram: " + std::move(why)); };
  if (!mechanism_) return refuse("no mechanism is loaded");
  if (parked_) {
    return refuse(fmt::format("a program is parked already, on {}; take it up, or drop it with DropParkedProgram",
                              parked_->mechanism));
  }
  const ServoStatus now = status();
  const CycleObservation seen = observe(now);
  const CycleState state = sequencer_.state();
  if (state != CycleState::Holding && state != CycleState::Idle) {
    return refuse(fmt::format("the machine is {}; hold the program with FeedHold first", to_string(state)));
  }
  if (!seen.at_rest) return refuse("the machine is still coming to rest; ask again when it stands");
  if (measurement_.pending() || sequencer_.positions()) return refuse("a jog or a measurement is held, not a program");
  if (changing_) return refuse("a tool change is under way; park when it is done");
  program_.keep(count_left());
  std::deque<ProgramStep> steps = program_.take();
  if (!steps.empty() && steps.front().way_back) steps.pop_front();
  if (steps.empty()) return refuse("nothing is queued");

  Parked parked;
  parked.mechanism = mechanism_->device.name;
  parked.virtual_mode = mechanism_->virtual_mode();
  ProgramStep& first = steps.front();
  parked.place = first.start;
  parked.place_joints = first.start_joints;
  const auto place = mechanism_->planner.farthest_place();
  const Move* const move = std::get_if<Move>(&first.what);
  if (place && move != nullptr && place->move_id == move->id) {
    first.from_mm = place->s_mm;
    parked.place = place->pose;
    parked.place_joints = place->joints;
  }
  parked.steps = std::move(steps);
  parked.mode = sequencer_.mode();
  parked.spindle_rpm = wishes_.spindle_rpm;
  parked.outputs = wishes_.outputs & outputs_off;
  parked.override_percent = override_percent_;
  wishes_.spindle_rpm.fill(0);
  wishes_.outputs &= ~outputs_off;
  link_.wishes.write(wishes_);
  parked_ = std::move(parked);
  return sequencer_.stop_and_clear(StopCause::Parked).map([&] { settle(now); });
}

Expected<> MotionSupervisor::add_rest_of(const ProgramStep& first) {
  PathBuilder& builder = mechanism_->builder;
  PathBuilder ahead = builder;
  ahead.restart(first.start_joints, builder.frames());
  const Move* const move = std::get_if<Move>(&first.what);
  const bool in_joints = move != nullptr && in_joint_space(move->geometry);
  const Move slow{.id = kPositioningMoveId, .geometry = {}, .feed_mm_s = kSlowest_mm_s};
  if (!in_joints) {
    // Under other frames the same joints are a little beside the step's start: from there its joints are found.
    const auto there = ahead.build(way_to(slow, PathTargetGeometry{first.start}));
    if (!there) return tl::unexpected(there.error());
  }
  PathSegments rest;
  if (move != nullptr) {
    auto built = ahead.build(*move, first.from_mm);
    if (!built) return tl::unexpected(built.error());
    rest = std::move(*built);
  }
  const Place place = begin_of(rest, ahead);
  const ToolPose stands = builder.end_pose();
  if (distance(stands.tip, place.pose.tip) > kWayBack_mm || distance(stands.axis, place.pose.axis) > kWayBack_axis) {
    return too_far(stands, place.pose);
  }
  PathBuilder back = builder;
  ProgramStep way = step_at(back, way_to(move != nullptr ? *move : slow, PathTargetGeometry{place.pose}));
  way.way_back = true;
  Move& way_move = std::get<Move>(way.what);
  if (in_joints) way_move.geometry = JointTargetGeometry{place.joints};
  auto built = back.build(way_move);
  if (!built) return tl::unexpected(built.error());
  for (std::size_t j = 0; j < place.joints.size(); ++j) {
    if (std::abs(back.end_joints()[j] - place.joints[j]) <= kSameJoints) continue;
    return failure(MinorCode::TravelLimit,
                   fmt::format("TakeUpProgram: joint {} stands at {:.4f}, and the program goes on with the tool there "
                               "and the joint at {:.4f}; turn it there first",
                               j, back.end_joints()[j], place.joints[j]));
  }
  builder = std::move(ahead);
  const Turn turn(*this);
  if (rebase_) return failure(MinorCode::Other, "TakeUpProgram: the machine was stopped meanwhile");
  const auto add = [this](const Move& added, PathSegments segments, ProgramStep step) {
    (void)add_built({&added, {}}, std::move(segments));
    program_.add(std::move(step), count_left());
  };
  if (!built->empty()) add(way_move, std::move(*built), way);
  if (move != nullptr) add(*move, std::move(rest), first);
  return {};
}

bool MotionSupervisor::hold_taken_up() {
  const Turn turn(*this);
  if (!parked_ || rebase_ || sequencer_.state() != CycleState::Idle) return false;
  sequencer_.take_up(parked_->mode, observe(status()));
  override_percent_ = parked_->override_percent;
  apply_override();
  resumes_with_ = std::exchange(parked_, std::nullopt);
  settle(status());
  return true;
}

void MotionSupervisor::drop_taken_up() {
  const Turn turn(*this);
  if (!mechanism_) return;
  mechanism_->planner.clear();
  rebase_ = true;
  forget_moves();
  news_.queue.push_back({QueueChange::Kind::Cleared, 0, status().progress.cycle});
}

void MotionSupervisor::restart_spindles() {
  if (!resumes_with_ || !mechanism_ || sequencer_.state() != CycleState::Running) return;
  wishes_.spindle_rpm = resumes_with_->spindle_rpm;
  wishes_.outputs |= resumes_with_->outputs;
  link_.wishes.write(wishes_);
  resumes_with_.reset();
  double patience_s = 0;
  for (const sdk::Spindle& spindle : mechanism_->device.spindles) {
    patience_s = std::max(patience_s, spindle.speed_timeout_s);
  }
  sequencer_.spindle_commanded(patience_s);
}

void MotionSupervisor::drop_parked(const std::string& why) {
  const Turn turn(*this);
  if (!parked_) return;
  note({Event::Kind::Mechanism,
        t_s_,
        0,
        fmt::format("the program that was parked on {} is dropped, with {} moves to do: {}", parked_->mechanism,
                    parked_->steps.size(), why),
        cycle_,
        {}});
  parked_.reset();
}

}  // namespace rmac::gateway
