#include "gateway/simulators/vdrive/axis/home_search.hpp"

namespace rmac::vdrive {

void HomeSearch::reset() noexcept {
  homing_.stop();
  asked_before_ = false;
}

double HomeSearch::step(const AxisParameters& parameters, const Shaft& shaft, bool standing) noexcept {
  const bool asks = (parameters.controlword & 0x10) != 0;
  const int method = parameters.homing_method;
  if (asks && !asked_before_ && Homing::knows(method)) homing_.start(method);
  if (!asks && homing_.state() == Homing::State::Running) homing_.stop();
  asked_before_ = asks;
  const double angle = shaft.angle();
  const double turn = shaft.turn_of(angle, parameters.switches.index);
  const int direction = homing_.step({.negative_limit = parameters.switches.at_negative_limit(angle),
                                      .positive_limit = parameters.switches.at_positive_limit(angle),
                                      .home_switch = parameters.switches.in_cam(angle),
                                      .index = turn != turn_,
                                      .standing = standing});
  turn_ = turn;
  return direction * (homing_.fast() ? parameters.fast : parameters.slow);
}

}  // namespace rmac::vdrive
