#pragma once

#include <optional>
#include <span>
#include <vector>

#include "gateway/collision/body_pair.hpp"
#include "gateway/collision/finding_list.hpp"
#include "gateway/collision/motion_bound.hpp"
#include "gateway/collision/scene.hpp"

namespace rmac::gateway {

/// Follows the joints and tells which bodies meet. Between two calls the joints go straight; no overlap deeper than the
/// clearance is missed on the way, by conservative advancement: a pair is looked at again when the motion since may
/// have used up its distance, and what lies between two looks is halved until it cannot hide that much. What is told to
/// meet did so at a moment that was looked at.
class CollisionChecker {
 public:
  CollisionChecker(LinkChain chain, std::vector<SceneBody> bodies, const Frame& part_frame, double clearance_mm);
  CollisionChecker(const CollisionChecker&) = delete;
  CollisionChecker& operator=(const CollisionChecker&) = delete;

  /// What is in the spindle from now on.
  void set_tool(const Tool& tool);
  void advance(double t_s, std::span<const double> joints, const MoveNow& move);

  /// Somebody else follows what is left of the stock, and adds to the findings what tools meet of it once it was cut.
  void stock_is_followed() noexcept { stock_followed_ = true; }

  /// Of all that was so far.
  [[nodiscard]] const FindingList& findings() const noexcept { return findings_; }
  [[nodiscard]] FindingList& findings() noexcept { return findings_; }
  [[nodiscard]] std::size_t distances_computed() const noexcept { return distances_; }

 private:
  struct Pair : BodyPair {
    double near_mm = 0;            ///< nearer than this is told
    double margin_mm = 0;          ///< motion that cannot bring them nearer than that
    double depth_mm = 0;           ///< as last measured, while they meet
    double unmeasured_mm = 1e300;  ///< motion since then
    std::optional<Apart> here{};   ///< as the last step ended, where it was looked at
    Finding* finding = nullptr;    ///< that is not over
  };
  struct Look {
    double at = 0;  ///< 0 to 1 of the way
    Apart apart;
  };

  void pair_up();
  void forget_what_was_near_stock();
  [[nodiscard]] Look look(const Pair& pair, double at);
  void examine(Pair& pair, const Look& from, const Look& to);
  void note(Pair& pair, const Look& look);

  LinkChain chain_;
  std::vector<SceneBody> bodies_;
  std::size_t without_tool_;  ///< bodies that are not the tool's
  double clearance_mm_;
  std::vector<Pair> pairs_;
  FindingList findings_;
  std::size_t distances_ = 0;

  // The step under way.
  Posture posture_, between_;
  std::vector<Posture::Radii> radii_;  ///< of each body
  std::vector<double> from_, way_, at_;
  double from_s_ = 0, to_s_ = 0;
  MoveNow move_;
  bool begun_ = false, stock_cut_ = false, stock_followed_ = false;
};

}  // namespace rmac::gateway
