#pragma once

#include <cstddef>
#include <optional>

#include "clients/legacy/apt/moves/cycle.hpp"
#include "clients/legacy/apt/moves/mover.hpp"

namespace rmac::apt {

/// CYCLE: each GOTO behind it is a hole, until CYCLE/OFF.
class Drilling {
 public:
  Drilling(const Coordinates& coordinates, Mover& mover, Writer& writer)
      : coordinates_(coordinates), mover_(mover), writer_(writer) {}

  /// CYCLE/type,…, ON and OFF.
  void set(Arguments& arguments);
  [[nodiscard]] bool on() const noexcept { return on_; }
  /// A hole whose top is there, along the tool axis.
  void drill(const Pose& top, std::size_t place);

 private:
  void go_above(const Pose& above, std::size_t place);
  void peck(const Pose& above, double feed_mm_min, std::size_t place);

  const Coordinates& coordinates_;
  Mover& mover_;
  Writer& writer_;
  std::optional<Cycle> cycle_;
  bool on_ = false;
  std::optional<double> began_mm_;  ///< how high along the tool axis the tool was before the first hole
};

}  // namespace rmac::apt
