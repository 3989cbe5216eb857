#pragma once

#include <optional>

#include "clients/legacy/apt/moves/arcs.hpp"
#include "clients/legacy/apt/moves/drilling.hpp"

namespace rmac::apt {

/// What moves the tool: GOTO and its like, arcs and holes.
class Motions {
 public:
  Motions(const Options& options, Coordinates& coordinates, Mover& mover, Writer& writer)
      : options_(options),
        coordinates_(coordinates),
        mover_(mover),
        arcs_(options, coordinates, mover),
        drilling_(coordinates, mover, writer) {}

  /// GOTO/x,y,z[,i,j,k].
  void go_to(Arguments& arguments);
  /// GODLTA/x,y,z[,i,j,k], or along the tool axis.
  void go_by(Arguments& arguments);
  /// FROM/x,y,z[,i,j,k], which moves nothing.
  void from(Arguments& arguments);
  /// GOHOME.
  void go_home(Arguments& arguments);
  /// RAPID, of the next motion only.
  void set_rapid(Arguments& arguments);
  /// FEDRAT.
  void set_feed(Arguments& arguments);
  /// TLON,GOFWD.
  void follow(Arguments& arguments);

  [[nodiscard]] Arcs& arcs() noexcept { return arcs_; }
  [[nodiscard]] Drilling& drilling() noexcept { return drilling_; }

 private:
  void move(const Pose& end, std::size_t place);
  [[nodiscard]] double take_feed(std::size_t place);

  const Options& options_;
  Coordinates& coordinates_;
  Mover& mover_;
  Arcs arcs_;
  Drilling drilling_;
  std::optional<double> feed_unit_;  ///< of FEDRAT, in mm/min, where one was said
  bool rapid_ = false;
};

}  // namespace rmac::apt
