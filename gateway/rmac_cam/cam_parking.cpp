#include "gateway/rmac_cam/cam_parking.hpp"

#include <fmt/format.h>

#include "gateway/mechanism/mechanism.hpp"
#include "rmac/motion/vector.hpp"

namespace rmac::gateway {
namespace {

constexpr const char* kTakeUp = "TakeUpProgram";

tl::unexpected<Error> nothing_parked(const char* function) {
  return failure(
      MinorCode::Other,
      fmt::format("{}: no program is parked; hold one with FeedHold and park it with ParkProgram", function));
}

/// 0 of a tool change.
std::int64_t id_of(const StepAsSent& step) {
  if (const auto* move = std::get_if<Move>(&step)) return move->id;
  const auto* turn = std::get_if<InTurn>(&step);
  return turn != nullptr ? turn->move_id : 0;
}

}  // namespace

Expected<> CamParking::park() {
  if (auto loaded = device_.require("ParkProgram"); !loaded) return loaded;
  parts_.forces.let_go();
  return supervisor_.parking().park(device_.coolant()).map([&] {
    settings_ = {parts_.path.values(), parts_.joints.values(), parts_.spindles.largest_rpm()};
  });
}

Expected<> CamParking::check_take_up(const gateway::Parking::Program& parked) {
  if (parked.mechanism != device_.get()->name || parked.virtual_mode != supervisor_.mechanism()->virtual_mode()) {
    return failure(MinorCode::Other, fmt::format("{}: the program was parked on {}{}; load that first", kTakeUp,
                                                 parked.mechanism, parked.virtual_mode ? " in virtual mode" : ""));
  }
  if (supervisor_.state() != CycleState::Idle) {
    return failure(MinorCode::Other, fmt::format("{}: the cycle is under way; stop it first", kTakeUp));
  }
  return {};
}

Expected<> CamParking::queue_again(const gateway::Parking::Program& parked) {
  auto queued = supervisor_.require_rest(kTakeUp).and_then([&] { return supervisor_.prepare_move(); }).and_then([&] {
    return supervisor_.parking().add_rest_of(parked.steps.front());
  });
  // What is left of a move is queued with the way to where it goes on.
  const bool begins_with_move = std::holds_alternative<Move>(parked.steps.front().what);
  for (std::size_t i = begins_with_move ? 1 : 0; queued && i < parked.steps.size(); ++i) {
    queued = queue_again(parked.steps[i].what);
  }
  if (queued && !supervisor_.parking().hold_taken_up()) {
    return failure(MinorCode::Other, fmt::format("{}: the machine was stopped meanwhile", kTakeUp));
  }
  return queued;
}

Expected<> CamParking::queue_again(const StepAsSent& step) {
  if (const auto* move = std::get_if<Move>(&step)) return supervisor_.add_move(*move).map([](bool) {});
  if (const auto* tool = std::get_if<int>(&step)) return parts_.tools.change_tool(*tool);
  return parts_.flow.queue_again(std::get<InTurn>(step));
}

Expected<> CamParking::take_up() {
  if (auto loaded = device_.require(kTakeUp); !loaded) return loaded;
  const auto& parked = supervisor_.parking().parked();
  if (!parked) return nothing_parked(kTakeUp);
  if (auto fits = check_take_up(*parked); !fits) return fits;
  if (auto queued = queue_again(*parked); !queued) {
    supervisor_.parking().drop_taken_up();
    (void)parts_.tools.keep_mounted();
    return failure(queued.error().code, fmt::format("{}; the program stays parked", queued.error().message));
  }
  parts_.path.take_up(settings_.path);
  parts_.joints.take_up(settings_.joints);
  parts_.spindles.take_up(settings_.spindle_max_rpm);
  return {};
}

Expected<> CamParking::drop() {
  if (!supervisor_.parking().parked()) return nothing_parked("DropParkedProgram");
  supervisor_.parking().drop("a client asked for it");
  return {};
}

std::optional<sdk::ParkedProgram> CamParking::parked() const {
  const auto& parked = supervisor_.parking().parked();
  if (!parked) return {};
  const ProgramStep& first = parked->steps.front();
  sdk::ParkedProgram told{parked->mechanism, parked->steps.size(), id_of(first.what), first.from_mm, parked->place, 0};
  if (device_.get() != nullptr) told.off_mm = rmac::distance(tool_.in_part().tip, told.place.tip);
  return told;
}

}  // namespace rmac::gateway
