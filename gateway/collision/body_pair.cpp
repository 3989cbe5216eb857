#include "gateway/collision/body_pair.hpp"

#include <algorithm>

namespace rmac::gateway {
namespace {

using Kind = SceneBody::Kind;

bool may_not_meet(const SceneBody& first, const SceneBody& second) {
  const std::size_t joints = std::max(first.link, second.link) - std::min(first.link, second.link);
  const bool of_machine = first.kind == Kind::Machine && second.kind == Kind::Machine;
  if (joints == 0 || (joints == 1 && of_machine)) return false;
  return first.kind == Kind::Part ? second.kind != Kind::Cutter : second.kind != Kind::CutterCore;
}

}  // namespace

std::vector<BodyPair> body_pairs(std::span<const SceneBody> bodies) {
  std::vector<BodyPair> pairs;
  for (std::size_t a = 0; a < bodies.size(); ++a) {
    for (std::size_t b = a + 1; b < bodies.size(); ++b) {
      if (!may_not_meet(bodies[a], bodies[b])) continue;
      const Kind on = bodies[a].kind, by = bodies[b].kind;
      const bool with_stock = on == Kind::Stock || by == Kind::Stock;
      pairs.push_back({.first = a,
                       .second = b,
                       .with_stock = with_stock,
                       .cutter_in_stock = with_stock && by == Kind::Cutter,
                       .tool_in_stock = with_stock && on_tool(by),
                       .core_in_part = by == Kind::CutterCore});
    }
  }
  return pairs;
}

}  // namespace rmac::gateway
