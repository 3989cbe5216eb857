#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "joins/path_joiner.hpp"
#include "planner/before_gate.hpp"
#include "rmac/motion/path_segment.hpp"
#include "rmac/motion/planner.hpp"
#include "time_law/path_view.hpp"

namespace rmac {

/// Two path lengths nearer than this are the same place: far below a setpoint's resolution, far above rounding.
inline constexpr double kSamePlace = 1e-7;

/// The path that is travelled: segments end to end on one path length, which goes on counting for as long as the
/// planner lives, from an origin that is moved after the tool. Behind its end stands the joiner with what was queued
/// and is not yet certain. Remembers which moves were done, and a stretch of what was travelled. Planner thread.
class LaidPath {
 public:
  LaidPath(std::vector<JointLimits> joints, double period_s);

  /// Where a gate is set, the path grows by what has passed it; else by what is certain.
  BeforeGate gate;

  void add(PathSegments moves);
  /// Drops everything; the path goes on from path length `s`.
  void clear(double s);

  /// Makes the path longer by what is certain, or does a part of the work that it takes; false where it is as long as
  /// before.
  bool supply();
  /// Parts of that work that were done; with one a step of the planner has done enough.
  [[nodiscard]] std::uint64_t work() const noexcept { return joiner_.work(); }
  /// Makes the path longer by what was held back for a join, where nothing can be supplied.
  void release();
  /// There is more for certain, or in work.
  [[nodiscard]] bool can_supply() const noexcept { return !gate.blocked() && (!gate.empty() || joiner_.ready()); }
  /// Something is queued that is not laid yet.
  [[nodiscard]] bool has_more() const noexcept { return !gate.empty() || !joiner_.empty(); }

  [[nodiscard]] PathView view() const noexcept { return {segments_, starts_}; }
  [[nodiscard]] std::size_t size() const noexcept { return segments_.size(); }
  [[nodiscard]] const std::shared_ptr<const PathSegment>& segment(std::size_t i) const noexcept { return segments_[i]; }
  [[nodiscard]] double start(std::size_t i) const noexcept { return starts_[i]; }
  [[nodiscard]] double end(std::size_t i) const noexcept { return starts_[i] + segments_[i]->length(); }
  /// The path demands rest at the end of this segment.
  [[nodiscard]] bool rest_after(std::size_t i) const noexcept { return rest_after_[i] != 0; }
  [[nodiscard]] double begin() const noexcept { return origin_; }
  [[nodiscard]] double end() const noexcept { return segments_.empty() ? origin_ : end(segments_.size() - 1); }
  /// The first demanded rest at or behind s, or `otherwise` when it comes first.
  [[nodiscard]] double next_rest(double s, double otherwise) const noexcept;
  /// Where the move ends that the machine is in, or stands before; lays path, or brings it before the gate, until it is
  /// known.
  [[nodiscard]] double next_move_end(double s);

  [[nodiscard]] std::uint64_t lines_merged() const noexcept { return joiner_.lines_merged(); }
  /// Moves added and not yet done.
  [[nodiscard]] std::size_t moves_left() const noexcept { return moves_left_; }
  /// Counts path length from a place `distance_mm` further along; in whole mm, which rounds nothing ahead of it.
  void move_origin(double distance_mm);
  /// The tool has come to s: counts the moves that ended, and drops what lies far behind it and behind `needed_from`.
  void travelled(double s, double needed_from);
  /// The farthest place that the tool has come to.
  [[nodiscard]] double farthest() const noexcept { return counted_s_; }
  /// The place at s; at a border the one where the next stretch begins. Nothing beyond what is laid.
  [[nodiscard]] std::optional<PathPlace> place_at(double s) const;

  /// What lies up to `distance` behind s, as a path of its own that ends no moves and runs the other way: it begins at
  /// path length s - (its length) and ends at s. Empty when nothing is remembered.
  [[nodiscard]] LaidPath backward(double s, double distance) const;
  /// A path without length at s, which something may be led in to.
  [[nodiscard]] LaidPath place(double s) const;
  /// What leads away from where this path begins leads there first, the other way; that ends no moves either. The path
  /// then begins so much before.
  void lead_in(const PathSegments& away);
  /// The pose to joints map of what lies at s; nullptr where nothing is laid.
  [[nodiscard]] const PoseToJoints* map_at(double s) const;

 private:
  void lay(const PathSegments& fresh);
  void append(std::shared_ptr<const PathSegment> segment);

  std::vector<JointLimits> joints_;
  double period_s_;
  PathJoiner joiner_;
  PathSegments segments_;
  std::vector<double> starts_;
  std::vector<char> rest_after_;
  double origin_ = 0;  ///< path length at which the first segment ever laid begins
  std::size_t moves_left_ = 0;
  double counted_s_ = -std::numeric_limits<double>::infinity();
};

}  // namespace rmac
