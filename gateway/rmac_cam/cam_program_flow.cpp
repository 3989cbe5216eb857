#include "gateway/rmac_cam/cam_program_flow.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "gateway/mechanism/mechanism.hpp"

namespace rmac::gateway {
namespace {

Expected<> check_time(const char* function, const char* parameter, double time_s) {
  if (std::isfinite(time_s) && time_s >= 0 && time_s <= sdk::ProgramFlow::kLongest_s) return {};
  return failure(MinorCode::InvalidParameterValue, fmt::format("{}: the {} of {:g} s must be 0 to {:g} s", function,
                                                               parameter, time_s, sdk::ProgramFlow::kLongest_s));
}

}  // namespace

Expected<> CamProgramFlow::add(const char* function, InTurn turn) {
  return device_.require(function).and_then([&] { return supervisor_.prepare_move(); }).and_then([&] {
    ProgramStep as_sent = step_at(supervisor_.mechanism()->builder, turn);
    std::vector<QueueStep> steps;
    steps.emplace_back(std::move(turn));
    return supervisor_.add_steps(function, std::move(steps), std::move(as_sent));
  });
}

Expected<> CamProgramFlow::dwell(std::int64_t id, double time_s) {
  return check_time("Dwell", "Time", time_s).and_then([&] { return add("Dwell", {id, Dwell{time_s}}); });
}

Expected<> CamProgramFlow::stop(std::int64_t id, bool optional, const std::string& message) {
  return add("ProgramStop", {id, ProgramStop{optional, message}});
}

Expected<> CamProgramFlow::await_input(std::int64_t id, const std::string& name, bool on, double timeout_s) {
  if (auto fine = check_time("AwaitInput", "TimeOut", timeout_s); !fine) return fine;
  const auto bit = device_.find_input(name, "AwaitInput");
  if (!bit) return tl::unexpected(bit.error());
  return add("AwaitInput", {id, AwaitInput{.bit = *bit, .on = on, .timeout_s = timeout_s, .name = name}});
}

Expected<> CamProgramFlow::in_turn(std::int64_t id, const std::vector<sdk::CallInTurn>& calls) {
  if (auto loaded = device_.require("InTurn"); !loaded) return loaded;
  Switch switching;
  for (const sdk::CallInTurn& call : calls) {
    if (const auto* speed = std::get_if<sdk::SpindleCall>(&call)) {
      auto switched = spindles_.in_turn(*speed);
      if (!switched) return tl::unexpected(switched.error());
      switching.speeds.push_back(*switched);
    } else {
      auto switched = spindles_.in_turn(std::get<sdk::OutputCall>(call));
      if (!switched) return tl::unexpected(switched.error());
      switching.outputs.push_back(std::move(*switched));
    }
  }
  return add("InTurn", {id, std::move(switching)});
}

Expected<> CamProgramFlow::queue_again(const InTurn& turn) {
  if (const auto* dwelling = std::get_if<Dwell>(&turn.what)) return dwell(turn.move_id, dwelling->time_s);
  if (const auto* stopping = std::get_if<ProgramStop>(&turn.what)) {
    return stop(turn.move_id, stopping->optional, stopping->message);
  }
  if (const auto* switching = std::get_if<Switch>(&turn.what)) {
    std::vector<sdk::CallInTurn> calls;
    for (const Switch::Speed& speed : switching->speeds) {
      calls.emplace_back(sdk::SpindleCall{static_cast<int>(speed.spindle), speed.rpm});
    }
    for (const Switch::Output& output : switching->outputs) {
      calls.emplace_back(sdk::OutputCall{output.name, output.on});
    }
    return in_turn(turn.move_id, calls);
  }
  const auto& input = std::get<AwaitInput>(turn.what);
  return await_input(turn.move_id, input.name, input.on, input.timeout_s);
}

}  // namespace rmac::gateway
