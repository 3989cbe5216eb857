#include "true_joint.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rmac::fault_test {

double TrueJoint::way_to_stop() const {
  constexpr double kUntilItBrakes = 0.003;  // the word's way to the drive, and what the drive takes to act
  constexpr double kGives = 0.05;           // mm or degrees: spring, bristles and brake come to rest
  const fieldbus::AxisPlantParameters& plant = plant_->parameters();
  const double most_nm = drive_.max_effort * drive_.nm_per_effort;
  const double inertia = plant.inertia_kg_m2();
  const double weight = std::abs(plant.gravity_nm);
  // A spring that took up what it had a moment ago gives it back, and so does what it came upon.
  const double thrown =
      met_stiffness_nm_rad > 0 ? std::abs(plant_->contact_nm()) / std::sqrt(met_stiffness_nm_rad * inertia) : 0;
  const double speed = std::hypot(fastest_, thrown) + (most_nm + weight) / inertia * kUntilItBrakes;
  const double brakes = std::max(plant.rated_torque_nm - weight, 0.1 * plant.rated_torque_nm);
  const double twist = plant.stiffness_nm_rad > 0 ? 2 * most_nm / plant.stiffness_nm_rad : 0;
  const double way = speed * kUntilItBrakes + speed * speed * inertia / (2 * brakes) + twist;
  return way * std::abs(drive_.mm_per_rad) + kGives;
}

bool TrueJoint::still_swings() const {
  constexpr double kSlowMs = 25, kGrows = 1.3, kLasts = 0.8, kHalf = 2;  // docs/servo.md, "A loop that swings"
  const bool large = last_swings_ > kHalf;
  return turns >= 7 && (large || last_swings_ >= (period_ms() > kSlowMs ? kGrows : kLasts) * first_swings_);
}

void TrueJoint::look(double position_set, double acceleration, bool broken) {
  if (!begun_) set_before_ = position_set;
  begun_ = true;
  const double way = std::abs(position_set - set_before_);
  set_before_ = position_set;
  constexpr double kForgets = 0.95;
  fastest_ = std::max({kForgets * fastest_, std::abs(plant_->load_rad_s()), std::abs(plant_->speed_rad_s())});
  path_speeds_up_ = since_swing > 0 && (path_speeds_up_ || acceleration != 0);
  if (since_effort > 0 || std::abs(effort_share()) > 0.25) ++since_effort;
  look_at_swings();
  if (!broken) return;
  if (since_break++ == 0) {
    set_at_break_ = position_set;
    stood_at_break_ = position();
  }
  if (since_commanded > 0 || way > 0) ++since_commanded;
  look_at_contact();
  most_contact = std::max(most_contact, std::abs(contact()));
  commanded += way;
  astray = std::max(astray, std::abs((position() - stood_at_break_) - (position_set - set_at_break_)));
}

/// It may come back from what it met for a moment.
void TrueJoint::look_at_contact() {
  constexpr int kMoment = 20;
  away_ = plant_->contact_nm() != 0 ? 0 : away_ + 1;
  if (away_ > kMoment) since_contact = 0;
  if (since_contact == 0 && away_ > 0) return;
  if (since_contact++ == 0) commanded = 0;
}

std::optional<double> TrueJoint::Turns::step(double now, double least) {
  if (rises ? now >= extreme : now <= extreme) extreme = now;
  if (std::abs(now - extreme) <= least) return std::nullopt;
  rises = !rises;
  return std::exchange(extreme, now);
}

void TrueJoint::look_at_swings() {
  constexpr double kSwing = 0.2, kDecays = 0.8;
  constexpr int kSlowestTurn = 60;
  if (since_swing > 0) ++since_swing;
  if (since_swing > 0 && since_swing - last_turn_ > kSlowestTurn) since_swing = turns = chain = last_turn_ = 0;
  const std::optional<double> turned = swings_.step(effort_share(), kSwing);
  if (!turned) return;
  const double swing = std::abs(*turned - std::exchange(turned_at_, *turned));
  if (since_swing == 0) since_swing = 1;
  ++turns;
  ++chain;
  last_turn_ = since_swing;
  last_swings_ = swing + swing_before_;
  swing_before_ = swing;
  if (turns == 4) first_swings_ = last_swings_;
  // What becomes smaller is no fault as long as it does.
  if (turns > 4 && last_swings_ < kDecays * first_swings_) since_swing = turns = last_turn_ = 1;
}

}  // namespace rmac::fault_test
