#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "gateway/collision/ahead/obstacle.hpp"
#include "gateway/collision/ahead/segment_chords.hpp"
#include "gateway/collision/body_pair.hpp"
#include "gateway/collision/motion_bound.hpp"
#include "gateway/collision/scene.hpp"

namespace rmac::gateway {

/// How far a path may be travelled before two bodies come nearer to each other than the clearance: by conservative
/// advancement, as `CollisionChecker` does it, along the path that is planned. Bodies that begin nearer may part, and
/// come no nearer than that. What is said to be clear at its end was looked at there: nothing is nearer than the
/// clearance (docs/decisions/0017-checked-before-it-moves.md). One thread at a time.
class ClearWay {
 public:
  ClearWay(LinkChain chain, std::vector<SceneBody> bodies, const Frame& part_frame, double clearance_mm);
  ClearWay(const ClearWay&) = delete;
  ClearWay& operator=(const ClearWay&) = delete;

  /// What is in the spindle from now on; the next segment begins anew.
  void set_tool(const Tool& tool);
  /// The next segment begins anywhere.
  void begin() noexcept { begun_ = false; }

  struct Checked {
    double clear_to = 0;  ///< path length on the segment
    bool whole = false;
    std::optional<Obstacle> obstacle{};  ///< why not
  };
  /// Of a segment that follows the one before, from a place on it; at least one stretch of it, and no more after so
  /// much work that others wait for the answer.
  [[nodiscard]] Checked check(const PathSegment& segment, double from_s);

  /// Something was cut from the stock: what is left of it is not looked at any more.
  [[nodiscard]] bool stock_cut() const noexcept { return has_stock_ && stock_cut_; }

 private:
  struct Pair : BodyPair {
    double wanted_mm = 0;     ///< apart
    double floor_mm = 1e300;  ///< the same, or less where they began nearer
    double margin_mm = 0;     ///< motion that cannot bring them nearer than that
  };
  struct Look {
    double at = 0;  ///< 0 to 1 of the chord
    Apart apart;
  };
  struct Stop {
    double at = 0;
    const Pair* pair = nullptr;
  };

  void pair_up();
  [[nodiscard]] bool counts(const Pair& pair) const noexcept;
  [[nodiscard]] double floor_of(const Pair& pair) const noexcept;
  /// Sets the floors where the machine stands; a pair that meets there.
  [[nodiscard]] const Pair* start_at(const Chord::Joints& joints);
  [[nodiscard]] std::optional<Stop> advance(const Chord& chord);
  [[nodiscard]] Apart apart(const Pair& pair, const Chord::Joints& joints);
  [[nodiscard]] Look look(const Pair& pair, const Chord& chord, double at);
  /// Where on the chord they are last apart enough, between a look at which they are and another; none: they are.
  [[nodiscard]] std::optional<double> leaves(const Pair& pair, const Chord& chord, const Look& from, const Look& to);
  /// The most that a pair moves between two places of the chord, straight; and what of it is beside that.
  [[nodiscard]] std::pair<double, double> bound(const Pair& pair, const Chord& chord, double from, double to);
  /// The place before `s` at which all are apart enough, by the segment's own joints.
  [[nodiscard]] double settle(const PathSegment& segment, double from_s, double s);
  [[nodiscard]] Obstacle describe(const PathSegment& segment, const Pair& pair, double s);

  LinkChain chain_;
  std::vector<SceneBody> bodies_;
  std::size_t without_tool_;  ///< bodies that are not the tool's
  Eigen::Isometry3d to_part_;
  double clearance_mm_;
  std::vector<Pair> pairs_;
  Chord::Joints most_beside_{};
  Posture posture_;
  bool begun_ = false, has_stock_ = false, stock_cut_ = false, cutting_ = false;
  std::size_t looks_ = 0;
};

}  // namespace rmac::gateway
