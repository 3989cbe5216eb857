#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gateway/mechanism/mechanism.hpp"
#include "gateway/rmac_cam/cam.hpp"

namespace rmac::gateway {
namespace {

tl::unexpected<Error> nothing_parked(const char* function) {
  return failure(
      MinorCode::Other,
      fmt::format("{}: no program is parked; hold one with FeedHold and park it with ParkProgram", function));
}

}  // namespace

Expected<> Cam::park_program() {
  if (auto loaded = require_mechanism("ParkProgram"); !loaded) return loaded;
  let_go_of_forces();
  return supervisor_.parking().park(begin_change().outputs_off).map([&] { parked_settings_ = settings_; });
}

Expected<> Cam::take_up_program() {
  constexpr const char* kFunction = "TakeUpProgram";
  if (auto loaded = require_mechanism(kFunction); !loaded) return loaded;
  const auto& parked = supervisor_.parking().parked();
  if (!parked) return nothing_parked(kFunction);
  if (parked->mechanism != device_->name || parked->virtual_mode != supervisor_.mechanism()->virtual_mode()) {
    return failure(MinorCode::Other, fmt::format("{}: the program was parked on {}{}; load that first", kFunction,
                                                 parked->mechanism, parked->virtual_mode ? " in virtual mode" : ""));
  }
  if (supervisor_.state() != CycleState::Idle) {
    return failure(MinorCode::Other, fmt::format("{}: the cycle is under way; stop it first", kFunction));
  }
  auto queued = supervisor_.require_rest(kFunction).and_then([&] { return supervisor_.prepare_move(); }).and_then([&] {
    return supervisor_.parking().add_rest_of(parked->steps.front());
  });
  const bool begins_with_tool = std::holds_alternative<int>(parked->steps.front().what);
  for (std::size_t i = begins_with_tool ? 0 : 1; queued && i < parked->steps.size(); ++i) {
    const auto& what = parked->steps[i].what;
    const Move* const move = std::get_if<Move>(&what);
    queued = move != nullptr ? supervisor_.add_move(*move).map([](bool) {}) : change_tool(std::get<int>(what));
  }
  if (queued && !supervisor_.parking().hold_taken_up()) {
    queued = failure(MinorCode::Other, fmt::format("{}: the machine was stopped meanwhile", kFunction));
  }
  if (!queued) {
    supervisor_.parking().drop_taken_up();
    (void)keep_mounted();
    return failure(queued.error().code, fmt::format("{}; the program stays parked", queued.error().message));
  }
  settings_ = parked_settings_;
  settings_.max_feedrate_mm_min = std::min(settings_.max_feedrate_mm_min, device_->max_feedrate_mm_min);
  return {};
}

Expected<> Cam::drop_parked_program() {
  if (!supervisor_.parking().parked()) return nothing_parked("DropParkedProgram");
  supervisor_.parking().drop("a client asked for it");
  return {};
}

std::optional<sdk::ParkedProgram> Cam::parked_program() const {
  const auto& parked = supervisor_.parking().parked();
  if (!parked) return {};
  const ProgramStep& first = parked->steps.front();
  const Move* const move = std::get_if<Move>(&first.what);
  sdk::ParkedProgram told{parked->mechanism, parked->steps.size(), move != nullptr ? move->id : 0,
                          first.from_mm,     parked->place,        0};
  if (device_ == nullptr) return told;
  const Vector& at = tool_pose_set().tip;
  const Vector& place = told.place.tip;
  told.off_mm = std::hypot(at[0] - place[0], at[1] - place[1], at[2] - place[2]);
  return told;
}

}  // namespace rmac::gateway
