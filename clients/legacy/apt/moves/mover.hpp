#pragma once

#include <cstddef>
#include <optional>

#include "clients/legacy/apt/moves/options.hpp"
#include "clients/legacy/apt/moves/vectors.hpp"

namespace rmac::apt {

/// Moves the tool, in coordinates of the part, and sees that all is written which a move of `.rmac` needs before it.
/// Places are for refusals.
class Mover {
 public:
  Mover(const Options& options, Writer& writer) : options_(options), writer_(writer) {}

  void set_feed(double mm_min) noexcept { feed_mm_min_ = mm_min; }
  /// The feed in force. Throws a Refusal where there is none.
  [[nodiscard]] double feed(std::size_t place) const;

  void rapid(const Pose& end, std::size_t place);
  void line(const Pose& end, double feed_mm_min, std::size_t place);
  /// `axis`: the tool's at the arc's end.
  void arc(const legacy::Arc& arc, const Point& axis, double feed_mm_min, std::size_t place);
  /// Where the tool is; made known by the approach, with this axis, where nothing else tells it.
  [[nodiscard]] const Pose& start(const Point& axis, std::size_t place);
  /// A changer leaves the tool elsewhere.
  void forget() noexcept { here_.reset(); }

 private:
  void write_feed(double mm_min, std::size_t place);
  void move_to(const Pose& end);
  static void require_reach(const Point& point, std::size_t place);

  const Options& options_;
  Writer& writer_;
  std::optional<Pose> here_;
  double feed_mm_min_ = 0, written_mm_min_ = 0;
};

}  // namespace rmac::apt
