#include "gateway/rmac/simulator/simulator.hpp"

#include <fmt/format.h>

#include <span>
#include <utility>

#include "gateway/rmac/simulator/mounted_tool.hpp"
#include "gateway/rmac/wire/requests.hpp"

namespace rmac::cli {
namespace {

/// Without drives nothing outside of the machine can still set it going, so this is long.
constexpr double kStuckAfter_s = 1;

/// The one parameter, by name or by place; what is no number is refused where it is called.
void scale_first(nlohmann::json& params, double share) {
  if (share == 1 || params.empty() || !params.is_structured() || !params.front().is_number()) return;
  params.front() = params.front().get<double>() * share;
}

/// `loops`: null where no drives ran.
JointSample to_note(const gateway::CycleSample& sample, const ServoReport* loops) {
  const auto joints = [&](const auto& values) {
    return std::vector<double>(values.begin(), values.begin() + sample.joint_count);
  };
  JointSample note;
  note.t_s = sample.t_s;
  note.cycle = sample.cycle;
  note.move_id = sample.move_id;
  note.moving = sample.moving;
  note.s_mm = sample.s_mm;
  note.feed_mm_s = sample.feed_set_mm_s;
  note.pose = {sample.pose_set.tip[0],  sample.pose_set.tip[1],  sample.pose_set.tip[2],
               sample.pose_set.axis[0], sample.pose_set.axis[1], sample.pose_set.axis[2]};
  note.position_set = joints(sample.position_set);
  note.velocity_set = joints(sample.velocity_set);
  note.acceleration_set = joints(sample.acceleration_set);
  if (loops != nullptr) {
    note.position = joints(loops->position);
    note.following_error = joints(loops->following_error);
  }
  return note;
}

}  // namespace

Simulator::Simulator(gateway::Simulation& simulation, const Program& program, const std::string& record_file)
    : simulation_(simulation), program_(program), account_(simulation.period_s()), order_(program) {
  if (!record_file.empty()) record_.emplace(record_file);
  gateway::Controller& controller = simulation_.controller();
  if (controller.mechanism() != nullptr) account_.mechanism(*controller.mechanism());
  controller.on_sample([this](const gateway::CycleSample& sample) { take(sample); });
  controller.on_event([this](const gateway::Event& event) { take(event); });
  controller.on_queued([this](const auto& move, auto segments) {
    account_.queued(move, segments);
    if (watch_ != nullptr) watch_->queued(move);
  });
}

Result<SimulationReport> Simulator::run() {
  if (record_) {
    if (auto opened = record_->open(); !opened) return tl::unexpected(opened.error());
  }
  // A run that ended at a collision has not failed: it tells what it set out to.
  if (auto played = play(); !played && !ended_) return tl::unexpected(played.error());
  if (dynamics_ != nullptr) dynamics_->finish();
  if (watch_ != nullptr) watch_->finish();
  SimulationReport report;
  if (record_) {
    if (auto closed = record_->close(); !closed) return tl::unexpected(closed.error());
    report.record_rows = record_->rows();
    report.record_files = record_->files();
  }
  report.moves = moves_.moves_done();
  report.tool_changes = moves_.tools_changed();
  report.cycle_time_s = moves_.cycle_time_s();
  report.length_mm = account_.length_mm();
  report.joints = account_.joints();
  report.limited_by = account_.shares();
  report.move_limits = std::move(move_limits_);
  return report;
}

Result<> Simulator::play() {
  if (share_of_feed_ != 1) {
    if (auto slower = call(kSetOverride, {{"Percent", 100}}); !slower) return slower;
  }
  for (const Request& request : program_.requests) {
    line_ = request.line;
    if (auto done = submit(request); !done) return done;
  }
  if (auto ended = order_.check_end(!moves_.empty()); !ended) return ended;
  return settle();
}

Result<> Simulator::submit(const Request& request) {
  if (auto possible = order_.check(request, !moves_.empty()); !possible) return possible;
  if (auto settled = order_.waits_for_rest(request) ? settle() : Result<>(); !settled) return settled;
  if (auto started = order_.needs_cycle(request) ? start_cycle_of_moves() : Result<>(); !started) return started;
  if (auto room = make_room(request); !room) return room;
  if (request.timing == Timing::Move) moves_.sent(request);
  order_.sent(request);
  return call(request.method, request.params());
}

Result<> Simulator::make_room(const Request& request) {
  // A measured point ends where the part is: what comes next begins there, once the machine has seen that it stands.
  if (order_.waits_for_measurement()) {
    return run_until([this] { return moves_.empty() && simulation_.controller().cam().queue().moves_left() == 0; });
  }
  if (request.timing == Timing::Move && order_.started()) {
    const auto capacity = static_cast<int>(simulation_.queue_capacity());
    return run_until([&] { return simulation_.controller().cam().queue().moves_left() < capacity; });
  }
  if (request.timing == Timing::Start) {
    // In manual mode a start is for one move: the one before must be over.
    return run_until([this] {
      const gateway::CycleNow now = simulation_.controller().cycle_now();
      return now.state != gateway::CycleState::Running ||
             std::string_view(now.mode) != name_of(sdk::CycleMode::Manual) || moves_.empty();
    });
  }
  return {};
}

Result<> Simulator::start_cycle_of_moves() {
  // Refused for as long as the machine needs to see that a jog is over.
  constexpr int kTries = 50;
  Result<> started = fail("");
  for (int i = 0; i < kTries && !started; ++i) {
    if (i > 0) simulation_.cycle();
    started = call(kStartCycle, {{"Mode", name_of(sdk::CycleMode::Automatic)}});
  }
  if (started) order_.cycle_started();
  return started;
}

Result<> Simulator::settle() {
  auto rested = run_until([this] { return moves_.empty() && at_rest(); });
  // One more cycle: a jog is over when the machine has seen that it stands.
  simulation_.cycle();
  return rested;
}

Result<> Simulator::run_until(const std::function<bool()>& reached) {
  double still_s = 0;
  while (!reached()) {
    simulation_.cycle();
    if (std::exchange(tool_asked_for_, false)) {
      gateway::ToolPort& tools = simulation_.controller().tools();
      if (auto in = tools.confirm_tool(tools.tools_now().wanted.value_or(gateway::kNoTool)); !in) {
        return fail_at(line_, in.error().message);
      }
    }
    if (std::exchange(stopped_, false)) {
      // Nobody stands beside it who would have something to see to.
      if (auto goes_on = simulation_.controller().cam().cycle().resume(); !goes_on) {
        return fail_at(line_, goes_on.error().message);
      }
    }
    const int line = moves_.line().value_or(line_);
    ended_ = ends_at_first_ && watch_ != nullptr && watch_->findings().collided();
    if (ended_) return fail_at(line, "collision");
    ended_ = ends_early();
    if (ended_) return fail_at(line, "the axes do not keep to the program");
    if (!failure_.empty()) return fail_at(line, failure_);
    still_s = moving_ || dwells() ? 0 : still_s + simulation_.period_s();
    if (still_s > kStuckAfter_s) return fail_at(line, stuck());
  }
  return {};
}

bool Simulator::ends_early() const {
  if (dynamics_ == nullptr) return false;
  const gateway::AxisDynamics& axes = dynamics_->axes();
  return axes.stopped() || (ends_off_path_ && !axes.deviation().off_path().empty());
}

bool Simulator::dwells() {
  return std::string_view(simulation_.controller().cycle_now().waits_for) == "dwell";
}

bool Simulator::at_rest() {
  gateway::Controller& controller = simulation_.controller();
  return !moving_ && controller.cam().queue().moves_left() == 0 &&
         controller.cycle_now().state != gateway::CycleState::Stopping;
}

tl::unexpected<Failure> Simulator::fail_at(int line, const std::string& message) const {
  return fail(fmt::format("{}:{}: {}", program_.file, line, message));
}

std::string Simulator::stuck() {
  const gateway::CycleNow now = simulation_.controller().cycle_now();
  return fmt::format(
      "the machine stands still in state {} with the feed override at {} %, and nothing in the program "
      "sets it going again: {} moves are not done",
      gateway::to_string(now.state), now.override_percent, moves_.size());
}

Result<> Simulator::call(const std::string& method, nlohmann::json params) {
  if (may_change_tool(method)) tool_may_have_changed();
  if (method == kSetOverride) scale_first(params, share_of_feed_);
  const gateway::Answer answer = simulation_.call(method, std::move(params));
  if (dynamics_ != nullptr && !method.starts_with("RMAC_CAM.")) dynamics_->configuration_may_have_changed();
  return answer ? Result<>() : fail_at(line_, fmt::format("{}: {}", method, answer.error().message));
}

void Simulator::tool_may_have_changed() {
  if (watch_ != nullptr) watch_->tool_may_have_changed();
  if (dynamics_ != nullptr) dynamics_->tool_may_have_changed();
  if (listener_ != nullptr) listener_->tool_may_have_changed();
}

void Simulator::take(const gateway::CycleSample& sample) {
  moving_ = sample.moving;
  account_.cycle(sample, simulation_.controller().cycle_now().override_percent);
  const int line = moves_.line().value_or(line_);
  gateway::Controller& controller = simulation_.controller();
  std::optional<TrueCycle> moved;
  if (dynamics_ != nullptr) moved = dynamics_->cycle(sample, line, controller);
  const gateway::CycleSample& seen = moved ? moved->sample : sample;
  if (watch_ != nullptr) {
    watch_->cycle(seen, line, controller, moved ? moved->bend_mm : Eigen::Vector3d::Zero());
  }
  if (listener_ != nullptr) {
    listener_->cycle(sample, {line, std::span(seen.position_set).first(seen.joint_count), account_, controller});
  }
  // As in a record of `rmac run`: every cycle from the first move on.
  if (!record_ || !(sample.moving || record_->rows() > 0)) return;
  const ServoReport* const loops = dynamics_ != nullptr ? &dynamics_->axes().report() : nullptr;
  if (auto added = record_->add(to_note(sample, loops)); !added && failure_.empty()) failure_ = added.error().message;
}

void Simulator::take(const gateway::Event& event) {
  using Kind = gateway::Event::Kind;
  if (event.kind == Kind::Mechanism) {
    if (const sdk::DeviceObject* device = simulation_.controller().mechanism()) account_.mechanism(*device);
  } else if (event.kind == Kind::MoveStarted) {
    moves_.started(event.t_s);
  } else if (event.kind == Kind::MoveDone) {
    move_limits_.push_back({event.move_id, account_.move_done()});
    if (watch_ != nullptr) watch_->move_done();
    moves_.done(event.move_id, event.t_s);
  } else if (event.kind == Kind::ToolWanted) {
    tool_asked_for_ = true;
  } else if (event.kind == Kind::ToolChanged) {
    moves_.tool_changed();
    tool_may_have_changed();
  } else if (event.kind == Kind::ProgramStopped && event.code == MinorCode::None) {
    stopped_ = true;
  } else if ((event.kind == Kind::Fault || event.code != MinorCode::None) && failure_.empty()) {
    failure_ = event.message;
  }
}

}  // namespace rmac::cli
