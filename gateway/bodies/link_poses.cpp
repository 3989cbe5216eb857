#include "gateway/bodies/link_poses.hpp"

#include <array>

#include "gateway/bodies/link.hpp"
#include "rmac/motion/frame.hpp"
#include "rmac/motion/machine_size.hpp"

namespace rmac::gateway {

LinkPoses::LinkPoses(LinkChain chain, std::span<const std::string> names)
    : chain_(std::move(chain)), base_(link_number(names, kBase).value_or(0)) {
  const auto add = [&](const std::string& name) {
    names_.push_back(name);
    numbers_.push_back(link_number(names, name).value_or(base_));
  };
  add(kBase);
  for (const std::string& name : names) {
    if (name != kBase) add(name);
  }
  add(kSpindle);
  add(kTable);
}

void LinkPoses::at(std::span<const double> joints, std::span<Frame> poses) const noexcept {
  std::array<Frame, kMaxJoints + 1> in_table{};
  chain_.displace(joints, std::span(in_table).first(chain_.link_count()));
  const Frame to_base = inverse(in_table[base_]);
  for (std::size_t i = 0; i < numbers_.size(); ++i) {
    poses[i] = numbers_[i] == base_ ? Frame{} : compose(to_base, in_table[numbers_[i]]);
  }
}

}  // namespace rmac::gateway
