#pragma once

namespace rmac::servo_test {

inline constexpr double kPeriod = 0.001;  ///< of a cycle, s

}  // namespace rmac::servo_test
