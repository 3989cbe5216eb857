#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "gateway/forces/end_mill.hpp"
#include "gateway/forces/force_coefficients.hpp"
#include "gateway/forces/turn_forces.hpp"

namespace rmac::gateway {

/// What pieces of edge give: force by its three directions on the tool, against their motion, and torque.
struct EdgeSum {
  Eigen::Vector3d force{0, 0, 0};  ///< N
  double tangential = 0;           ///< N
  double torque = 0;               ///< N·mm

  void add(double by, const EdgeSum& other) {
    force += by * other.force, tangential += by * other.tangential, torque += by * other.torque;
  }
};

/// The edges of an end mill in material, as `forces_over_turn` has them; what is given outlives this.
class EdgeForces {
 public:
  EdgeForces(const EndMill& mill, const ForceCoefficients& material, std::span<const EngagedSlice> slices,
             const ToothFeed& feed)
      : mill_(mill), k_(material), slices_(slices), feed_(feed) {}

  /// Of all teeth, over the time.
  [[nodiscard]] EdgeSum mean() const;
  /// Of all teeth, the lowest point of one of them at this angle.
  [[nodiscard]] EdgeSum at(double angle) const;
  /// By how much the mean force changes with the way of the tool since the tooth before, N/mm: a column for each of its
  /// x, y and z. Of a material without edge forces.
  [[nodiscard]] Eigen::Matrix3d mean_change() const;
  /// The same of the force of a moment.
  [[nodiscard]] Eigen::Matrix3d change_at(double angle) const;
  /// Angles of the tool to look at within a pitch of its teeth.
  [[nodiscard]] std::vector<double> positions() const;
  /// mm³ for each turn.
  [[nodiscard]] double chip_mm3() const;

 private:
  /// How thick a chip is along the angle φ: so much of its sine, so much of its cosine, and a level.
  struct Chip {
    double sine = 0, cosine = 0, level = 0;
  };
  [[nodiscard]] Chip chip_of_feed(const EndMill::Place& place) const;
  /// Of ways of 1 mm along x, y and z.
  [[nodiscard]] static std::array<Chip, 3> chips_of_ways(const EndMill::Place& place);
  [[nodiscard]] double chip(const EndMill::Place& place, double angle) const;
  [[nodiscard]] EdgeSum on_tool(const EndMill::Place& place, double angle, double t, double r, double a) const;
  /// Calls `visit(from, to)` for pieces of the profile between two heights on which nothing turns far.
  template <class Visit>
  void along_profile(double low_mm, double high_mm, double most_turned, Visit&& visit) const;
  /// Calls `visit(place, from, to, weight)` for places of the edges and the angles at which there is a chip; with their
  /// weights they make a mean over a turn, of all teeth.
  template <class Visit>
  void over_edges(Visit&& visit) const;
  /// Calls `visit(from, to)` for the angles of an arc at which the feed leaves a chip.
  template <class Visit>
  void over_chips(const EndMill::Place& place, const Arc& arc, Visit&& visit) const;
  /// Of one tooth at one place, for each millimetre of profile, integrated between two angles.
  void add_between(double from, double to, const EndMill::Place& place, const Chip& chip, EdgeSum& sum) const;
  /// Calls `visit(place, angle, weight)` for places of all teeth's edges that are in material with the tool at an
  /// angle.
  template <class Visit>
  void at_edges(double angle, Visit&& visit) const;
  /// The same of one tooth in an arc of a slice.
  template <class Visit>
  void on_tooth(const EngagedSlice& slice, const Arc& arc, double lowest, Visit&& visit) const;
  /// The same of a piece so short that the chip begins or ends at most once on it.
  template <class Visit>
  void on_piece(double from, double to, double lowest, Visit&& visit) const;

  const EndMill& mill_;
  ForceCoefficients k_;
  std::span<const EngagedSlice> slices_;
  ToothFeed feed_;
};

}  // namespace rmac::gateway
