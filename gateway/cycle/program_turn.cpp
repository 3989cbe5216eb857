#include "gateway/cycle/program_turn.hpp"

#include <fmt/format.h>

#include <utility>

namespace rmac::gateway {
namespace {

/// Machine time is a count of cycles: what is shorter than any is rounding.
constexpr double kRounding_s = 1e-9;

}  // namespace

ProgramTurn::Outcome ProgramTurn::take(const InTurn& turn, const Seen& seen) {
  if (!begun_) begin(turn);
  if (begun_->seen_s) begun_->waited_s += seen.t_s - *begun_->seen_s;
  begun_->seen_s = seen.t_s;
  prompt_.clear();
  const Outcome outcome = std::visit([&](const auto& what) { return go_on(turn, what, seen); }, turn.what);
  if (outcome == Outcome::Done || outcome == Outcome::SpindlesTold) end(turn);
  return outcome;
}

void ProgramTurn::begin(const InTurn& turn) {
  begun_ = Begun{};
  wishes_.change([&](ServoWishes& wishes) { wishes.in_turn = turn.move_id; });
  tell(Event::Kind::MoveStarted, turn, name_of(turn) + " started");
}

void ProgramTurn::end(const InTurn& turn) {
  begun_.reset();
  wishes_.change([](ServoWishes& wishes) { wishes.in_turn.reset(); });
  tell(Event::Kind::MoveDone, turn, name_of(turn) + " done");
}

void ProgramTurn::pause() noexcept {
  if (begun_) begun_->seen_s.reset();
}

void ProgramTurn::drop() {
  prompt_.clear();
  if (!begun_) return;
  begun_.reset();
  wishes_.change([](ServoWishes& wishes) { wishes.in_turn.reset(); });
}

ProgramTurn::Outcome ProgramTurn::go_on(const InTurn& /*turn*/, const Dwell& dwell, const Seen& /*seen*/) {
  begun_->waits_for = "dwell";
  return begun_->waited_s >= dwell.time_s - kRounding_s ? Outcome::Done : Outcome::Waits;
}

ProgramTurn::Outcome ProgramTurn::go_on(const InTurn& turn, const ProgramStop& stop, const Seen& /*seen*/) {
  if (begun_->held || (stop.optional && !optional_stops_)) return Outcome::Done;
  return hold(turn, stop.message.empty() ? name_of(turn) : fmt::format("{}: {}", name_of(turn), stop.message),
              "FeedResume goes on", MinorCode::None);
}

ProgramTurn::Outcome ProgramTurn::go_on(const InTurn& turn, const AwaitInput& input, const Seen& seen) {
  begun_->waits_for = "input";
  const bool on = (seen.inputs & input.bit) != 0;
  if (seen.virtual_mode || on == input.on) return Outcome::Done;
  if (begun_->waited_s <= input.timeout_s + kRounding_s) return Outcome::Waits;
  begun_->waited_s = 0;
  return hold(turn,
              fmt::format("{}: input {} did not go {} within {:g} s", name_of(turn), input.name,
                          input.on ? "on" : "off", input.timeout_s),
              "see to it; FeedResume waits for it once more", MinorCode::ResponseTimeout);
}

ProgramTurn::Outcome ProgramTurn::go_on(const InTurn& /*turn*/, const Switch& switching, const Seen& /*seen*/) {
  const SwitchOutputs outputs = outputs_of(switching);
  wishes_.change([&](ServoWishes& wishes) {
    for (const Switch::Speed& speed : switching.speeds) wishes.spindle_rpm[speed.spindle] = speed.rpm;
    wishes.outputs = (wishes.outputs & ~outputs.mask) | outputs.values;
  });
  return switching.speeds.empty() ? Outcome::Done : Outcome::SpindlesTold;
}

ProgramTurn::Outcome ProgramTurn::hold(const InTurn& turn, std::string prompt, const char* how_it_goes_on,
                                       MinorCode code) {
  begun_->held = true;
  tell(Event::Kind::ProgramStopped, turn,
       fmt::format("{}; the program is held: {} (rmac resume), StopNow drops it", prompt, how_it_goes_on), code);
  prompt_ = std::move(prompt);
  return Outcome::Held;
}

void ProgramTurn::tell(Event::Kind kind, const InTurn& turn, std::string message, MinorCode code) {
  Event event;
  event.kind = kind;
  event.move_id = turn.move_id;
  event.message = std::move(message);
  event.code = code;
  news_.tell_now(std::move(event));
}

}  // namespace rmac::gateway
