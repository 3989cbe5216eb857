#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "planner/laid_path.hpp"
#include "rmac/motion/error.hpp"
#include "rmac/motion/planner_model.hpp"

namespace rmac {

/// Which path is travelled: the queue's, `forward`; or a detour from it: back over what lies behind the tool, or from
/// beside the path to where it was left. Planner thread.
class Route {
 public:
  explicit Route(const PlannerModel& model) : forward(model.joints, model.period_s) {}

  LaidPath forward;

  /// The path that is travelled, or will be from rest.
  [[nodiscard]] LaidPath& path() noexcept { return detour_ ? detour_->path : forward; }
  [[nodiscard]] const LaidPath& path() const noexcept { return detour_ ? detour_->path : forward; }
  [[nodiscard]] bool on_detour() const noexcept { return detour_.has_value(); }
  [[nodiscard]] bool retraces() const noexcept { return detour_ && detour_->retraces; }
  [[nodiscard]] bool rejoins() const noexcept { return detour_ && !detour_->retraces; }
  /// The place on `forward` of a place on the path that is travelled, or at which the detour will come to it.
  [[nodiscard]] double on_forward(double s) const noexcept;
  /// The joints rest, or brake, beside the path, which was left at `turned_to`.
  [[nodiscard]] bool beside() const noexcept { return beside_; }
  /// Where on the path that was last turned to the machine stood then, or had left it; nothing before the first turn.
  [[nodiscard]] const std::optional<double>& turned_to() const noexcept { return turned_to_; }
  /// How often it turned to another path. Path lengths are one path's: those of plans from before the last turn say
  /// nothing about the one that is travelled.
  [[nodiscard]] std::uint64_t turns() const noexcept { return turns_; }

  /// The joints left the path at `s` of it, in motion.
  void leave(double s);

  // Only at rest, `s` being the place on the path that is travelled, or was left. `way`: from beside the path to where
  // it was left.

  struct WayBack {
    const PlannerModel& model;
    std::span<const double> from;  ///< joints
    double speed = 1;              ///< share of the joints' speeds
  };
  /// Readies the way back over what lies behind; its length, 0 when there is none.
  [[nodiscard]] Expected<double> turn_back(double s, double distance, const WayBack& way);
  /// From beside the path, readies the way to where it was left. An error leaves everything as it was.
  [[nodiscard]] Expected<> rejoin(const WayBack& way);
  /// Leaves the detour.
  void turn_forward(double s);
  /// Drops all paths; path length goes on counting.
  void clear(double s);

  /// How far joints are from where the path was left: the largest of all, mm or degrees.
  [[nodiscard]] double distance_to(std::span<const double> joints) const;

 private:
  struct Detour {
    LaidPath path;
    bool retraces = false;
    double meets_at = 0;  ///< path length on it, at which it comes to
    double place = 0;     ///< this place on `forward`, to go back from there where it retraces
  };
  /// What leads from where the path was left to `way.from`; nothing where the joints are there.
  [[nodiscard]] Expected<PathSegments> away(const WayBack& way) const;
  void take(Detour detour);
  void turn_to(double s) noexcept {
    turned_to_ = s;
    ++turns_;
  }

  std::optional<Detour> detour_;
  std::optional<double> turned_to_;
  std::uint64_t turns_ = 0;
  bool beside_ = false;
};

}  // namespace rmac
