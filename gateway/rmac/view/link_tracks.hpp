#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "gateway/bodies/link_chain.hpp"
#include "gateway/rmac/view/thinned_track.hpp"
#include "rmac/motion/pose.hpp"

namespace rmac::cli {

/// A ball that what stands on a link lies in, machine frame, all joints at 0. mm.
struct Reach {
  Eigen::Vector3d middle{0, 0, 0};
  double radius = 0;
};

/// Where the links of a machine stand over time, as the collision check has them, but seen from the base, which stands
/// on the ground. Of each link keys are kept, so that no place within its reach is farther off its true place than
/// `within_mm`, at the moments that were added.
class LinkTracks {
 public:
  static constexpr double kTolerance_mm = 0.01;
  static constexpr std::size_t kMostKeys = 400'000;  ///< of all links: 22 MB of the page

  /// `reaches`: of each link.
  LinkTracks(const gateway::LinkChain& chain, std::size_t base, std::span<const Reach> reaches,
             std::size_t most_keys = kMostKeys);

  void add(double t_s, std::span<const double> joints);
  /// Nothing is added behind it.
  void end();

  [[nodiscard]] double within_mm() const noexcept;
  [[nodiscard]] std::size_t keys() const noexcept;
  /// One link: `middle`, and of each key `t`, `p` (where the middle is then) and `q`.
  [[nodiscard]] nlohmann::json to_json(std::size_t link) const;

 private:
  struct Placed {
    Eigen::Vector3d middle;
    Eigen::Quaterniond turn;
  };
  struct PlacedWay {
    double radius = 0;
    [[nodiscard]] static Placed between(const Placed& a, const Placed& b, double share);
    [[nodiscard]] double apart(const Placed& a, const Placed& b) const;
  };

  const gateway::LinkChain& chain_;
  std::size_t base_, most_keys_;
  std::vector<Eigen::Vector3d> middles_;
  std::vector<ThinnedTrack<WaitingValues<Placed, PlacedWay>>> tracks_;
  std::vector<Frame> frames_;  ///< of the moment under way
};

}  // namespace rmac::cli
