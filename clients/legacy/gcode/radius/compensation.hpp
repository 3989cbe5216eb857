#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "clients/legacy/gcode/radius/offset.hpp"
#include "clients/legacy/program/writer.hpp"

namespace rmac::gcode {

/// A move in the coordinates of the part, mm: of a contour as it is programmed, or of the tool's centre beside it.
struct ContourMove {
  bool rapid = false;
  std::optional<legacy::Arc> arc;  ///< in XY, helices too; none: a straight move
  legacy::Point end{};
  double feed_mm_min = 0;
  std::size_t line = 0;  ///< of the source
};

/// Cutter radius compensation in XY: the contour goes in, and what the tool's centre does goes out. Where a move ends
/// the next one tells, so the last is held back. Outside corners are gone around by an arc, inside corners end where
/// both ways cross. Only moves that follow each other are held against each other. `place`: for a Refusal.
class Compensation {
 public:
  using Sink = std::function<void(const ContourMove& move, std::size_t place)>;
  /// `enters_to_normal`: before an inside corner the first move ends beside the begin of the second one, and not where
  /// that is crossed.
  explicit Compensation(Sink sink, bool enters_to_normal = false)
      : sink_(std::move(sink)), enters_to_normal_(enters_to_normal) {}

  /// G41 and G42: from where the tool is on. `left_mm`: the tool's radius; negative: right of the contour.
  void begin(double left_mm, const legacy::Point& at);
  /// G40, or the program's end: gives out what was held back.
  void end(std::size_t place);
  void move(const ContourMove& move, std::size_t place);

  /// The contour goes on from here: what rounding left between the end of an arc's circle and the end that is written.
  void go_on_from(const legacy::Point& place) noexcept { programmed_ = place; }

  [[nodiscard]] bool on() const noexcept { return state_ == State::On; }
  /// Behind end(), until left(): the tool is beside the contour, and the program goes on from the contour itself.
  [[nodiscard]] bool leaving() const noexcept { return state_ == State::Leaving; }
  void left() noexcept { state_ = State::Off; }
  /// Where the program believes the tool to be, while it is on or leaving.
  [[nodiscard]] const legacy::Point& programmed() const noexcept { return programmed_; }

 private:
  enum class State { Off, On, Leaving };
  struct Held {
    ContourMove move;
    Offset offset;
    double from = 0, to = 0;  ///< what of it is left beside its corners
    bool is_first = false;    ///< it does not go along its offset, but to it
  };

  void enter(const ContourMove& move, std::size_t place);
  [[nodiscard]] Offset offset_of(const ContourMove& move, std::size_t place) const;
  void turn_corner(const Offset& behind, const ContourMove& move, std::size_t place);
  void go_around(const Offset& behind, const ContourMove& move, double turn_rad, std::size_t place);
  void give_out(double to, std::size_t place);
  void give_out_depths(std::size_t place);
  void step_to(const Flat& to, const ContourMove& move, std::size_t place);

  Sink sink_;
  bool enters_to_normal_ = false;
  State state_ = State::Off;
  double left_mm_ = 0;
  legacy::Point programmed_{}, tool_{};  ///< the latter: as far as moves were given out
  std::optional<Held> held_;
  std::vector<ContourMove> depths_;  ///< moves in Z alone behind the one that is held
};

}  // namespace rmac::gcode
