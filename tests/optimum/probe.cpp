// Durations of `fastest_profile` for cases read from the input, eleven numbers each.
#include <cstdio>
#include <iostream>

#include "rmac/motion/state_to_state.hpp"

int main() {
  rmac::JointState from, to;
  rmac::MotionBounds b;
  while (std::cin >> from.position >> from.velocity >> from.acceleration >> to.position >> to.velocity >>
         to.acceleration >> b.min_velocity >> b.max_velocity >> b.min_acceleration >> b.max_acceleration >>
         b.max_jerk) {
    std::printf("%.17g\n", rmac::fastest_profile(from, to, b).duration());
  }
}
