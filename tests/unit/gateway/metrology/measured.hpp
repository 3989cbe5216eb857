#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "rmac/motion/frame.hpp"
#include "rmac/motion/vector.hpp"

namespace rmac::gateway {

/// Seeded places, directions and noise for what the fits are tried on.
class Chance {
 public:
  explicit Chance(unsigned seed) : random_(seed) {}

  double within(double a, double b) { return std::uniform_real_distribution<double>(a, b)(random_); }
  double noise(double sigma) { return sigma > 0 ? std::normal_distribution<double>(0, sigma)(random_) : 0.0; }
  Vector place(double reach) { return {within(-reach, reach), within(-reach, reach), within(-reach, reach)}; }
  Vector direction() {
    const double z = within(-1, 1), turn = within(0, 2 * M_PI), lean = std::sqrt(1 - z * z);
    return {lean * std::cos(turn), lean * std::sin(turn), z};
  }
  Frame frame(double reach, double most_turn_rad) {
    const Vector axis = direction();
    const double half = within(0, most_turn_rad) / 2;
    return {place(reach),
            {std::cos(half), std::sin(half) * axis[0], std::sin(half) * axis[1], std::sin(half) * axis[2]}};
  }

 private:
  std::mt19937 random_;
};

inline Vector plus(const Vector& a, const Vector& b, double times = 1) {
  return {a[0] + times * b[0], a[1] + times * b[1], a[2] + times * b[2]};
}
/// The angle by which two frames are turned against each other.
inline double turned(const Frame& a, const Frame& b) {
  const Frame c = compose(inverse(a), b);
  return 2 * std::hypot(c.q[1], c.q[2], c.q[3]);
}

}  // namespace rmac::gateway
