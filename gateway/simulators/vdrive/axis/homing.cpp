#include "gateway/simulators/vdrive/axis/homing.hpp"

namespace rmac::vdrive {

bool Homing::knows(int method) noexcept {
  return (method >= 1 && method <= 14) || (method >= 17 && method <= 30) || method == 33 || method == 34 ||
         method == 35 || method == 37;
}

Homing::Method Homing::method_of(int method) noexcept {
  if (method == 33) return {Sensor::None, -1, -1, false, true};
  if (method == 34) return {Sensor::None, 1, 1, false, true};
  if (method == 35 || method == 37) return {};
  constexpr int kFirstWithoutIndex = 17;
  const bool to_index = method < kFirstWithoutIndex;
  switch (to_index ? method : method - (kFirstWithoutIndex - 1)) {
    case 1:
      return {Sensor::NegativeLimit, -1, 1, true, to_index};
    case 2:
      return {Sensor::PositiveLimit, 1, -1, true, to_index};
    // Switches that stay closed to one side: 3 and 4 to the positive, 5 and 6 to the negative.
    case 3:
      return {Sensor::HomeSwitch, 1, -1, true, to_index};
    case 4:
      return {Sensor::HomeSwitch, 1, 1, false, to_index};
    case 5:
      return {Sensor::HomeSwitch, -1, 1, true, to_index};
    case 6:
      return {Sensor::HomeSwitch, -1, -1, false, to_index};
    // Cams: 7, 8, 13 and 14 take the edge on the negative side, 9 to 12 the one on the positive side.
    case 7:
      return {Sensor::HomeSwitch, 1, -1, true, to_index};
    case 8:
      return {Sensor::HomeSwitch, 1, 1, false, to_index};
    case 9:
      return {Sensor::HomeSwitch, 1, -1, false, to_index};
    case 10:
      return {Sensor::HomeSwitch, 1, 1, true, to_index};
    case 11:
      return {Sensor::HomeSwitch, -1, 1, true, to_index};
    case 12:
      return {Sensor::HomeSwitch, -1, -1, false, to_index};
    case 13:
      return {Sensor::HomeSwitch, -1, 1, false, to_index};
    default:
      return {Sensor::HomeSwitch, -1, -1, true, to_index};
  }
}

void Homing::start(int method) noexcept {
  method_ = method_of(method);
  reversed_ = returning_ = near_edge_ = found_ = false;
  direction_ = method_.first_direction;
  if (method_.sensor != Sensor::None) {
    phase_ = Phase::Reach;
  } else if (method_.to_index) {
    phase_ = Phase::Index;
  } else {
    phase_ = Phase::Here;
  }
}

Homing::State Homing::state() const noexcept {
  switch (phase_) {
    case Phase::Idle:
      return State::Idle;
    case Phase::Attained:
      return State::Attained;
    case Phase::Failed:
      return State::Failed;
    default:
      return State::Running;
  }
}

bool Homing::closed(const HomingInputs& inputs) const noexcept {
  switch (method_.sensor) {
    case Sensor::NegativeLimit:
      return inputs.negative_limit;
    case Sensor::PositiveLimit:
      return inputs.positive_limit;
    default:
      return inputs.home_switch;
  }
}

bool Homing::blocked(const HomingInputs& inputs, int direction) const noexcept {
  return (direction < 0 && inputs.negative_limit && method_.sensor != Sensor::NegativeLimit) ||
         (direction > 0 && inputs.positive_limit && method_.sensor != Sensor::PositiveLimit);
}

void Homing::take_edge() noexcept {
  phase_ = method_.to_index ? Phase::Index : Phase::Halt;
  found_ = !method_.to_index;
}

int Homing::reach(const HomingInputs& inputs) noexcept {
  if (closed(inputs)) {
    phase_ = Phase::Settle;
    return 0;
  }
  near_edge_ = true;  // it moves towards it; whether this is the edge, the direction says
  if (blocked(inputs, direction_)) {
    // The end of the travel: the switch must be the other way.
    phase_ = reversed_ ? Phase::Failed : phase_;
    direction_ = -direction_;
    reversed_ = true;
  }
  return phase_ == Phase::Failed ? 0 : direction_;
}

int Homing::step(const HomingInputs& inputs) noexcept {
  found_ = false;
  switch (phase_) {
    case Phase::Here:
      phase_ = Phase::Halt;
      found_ = true;
      return 0;
    case Phase::Reach:
      return reach(inputs);
    case Phase::Settle:
      if (!inputs.standing) return 0;
      if (!closed(inputs)) {  // it ran over it
        direction_ = -direction_;
        returning_ = true;
        phase_ = Phase::Reach;
        return direction_;
      }
      phase_ = method_.leaves && near_edge_ && direction_ == -method_.edge_direction ? Phase::Edge : Phase::Clear;
      return 0;
    case Phase::Clear: {
      const int direction = method_.leaves ? method_.edge_direction : -method_.edge_direction;
      if (blocked(inputs, direction)) phase_ = Phase::Failed;
      if (!closed(inputs)) phase_ = method_.leaves ? Phase::Return : Phase::Edge;
      return phase_ == Phase::Clear ? direction : 0;
    }
    case Phase::Return:
      direction_ = -method_.edge_direction;
      near_edge_ = true;
      if (closed(inputs)) phase_ = Phase::Settle;
      return phase_ == Phase::Return ? direction_ : 0;
    case Phase::Edge:
      if (closed(inputs) != method_.leaves) {
        take_edge();
        return method_.to_index ? method_.edge_direction : 0;
      }
      if (blocked(inputs, method_.edge_direction)) phase_ = Phase::Failed;
      return phase_ == Phase::Edge ? method_.edge_direction : 0;
    case Phase::Index:
      if (inputs.index) {
        phase_ = Phase::Halt;
        found_ = true;
        return 0;
      }
      if (blocked(inputs, method_.edge_direction)) phase_ = Phase::Failed;
      return phase_ == Phase::Index ? method_.edge_direction : 0;
    case Phase::Halt:
      if (inputs.standing) phase_ = Phase::Attained;
      return 0;
    default:
      return 0;
  }
}

}  // namespace rmac::vdrive
