#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "gateway/bodies/link_chain.hpp"

namespace rmac::gateway {

/// Where each link of a machine stands, by the names that a body's `link` may have: for whoever draws it.
class LinkPoses {
 public:
  /// `names`: those from the table to the spindle, with `base`, of which the chain was made.
  LinkPoses(LinkChain chain, std::span<const std::string> names);

  /// `base`, the joints from the table to the spindle, `spindle` and `table`.
  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return names_; }
  /// Of the joints, as the module counts them.
  [[nodiscard]] std::size_t joint_count() const noexcept { return chain_.link_count() - 1; }

  /// Of each name how its link is moved from where it stands with all joints at 0, in the frame that stays where the
  /// machine frame is then: that of the base. A body is at this times its own pose. `joints`: joint_count(); `poses`:
  /// one a name.
  void at(std::span<const double> joints, std::span<Frame> poses) const noexcept;

  /// Where the tool interface stands while all joints stand at 0; it moves with the spindle.
  [[nodiscard]] const Frame& interface_home() const noexcept { return chain_.interface_home(); }

 private:
  LinkChain chain_;
  std::vector<std::string> names_;
  std::vector<std::size_t> numbers_;  ///< of the link of each name
  std::size_t base_;
};

}  // namespace rmac::gateway
