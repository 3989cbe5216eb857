#include "gateway/rmac/view/link_tracks.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "gateway/rmac/view/rounded.hpp"
#include "rmac/motion/frame.hpp"

namespace rmac::cli {

using Eigen::Quaterniond;
using Eigen::Vector3d;

LinkTracks::Placed LinkTracks::PlacedWay::between(const Placed& a, const Placed& b, double share) {
  return {a.middle + (b.middle - a.middle) * share, a.turn.slerp(share, b.turn)};
}

double LinkTracks::PlacedWay::apart(const Placed& a, const Placed& b) const {
  return (a.middle - b.middle).norm() + radius * a.turn.angularDistance(b.turn);
}

LinkTracks::LinkTracks(const gateway::LinkChain& chain, std::size_t base, std::span<const Reach> reaches,
                       std::size_t most_keys)
    : chain_(chain), base_(base), most_keys_(most_keys), frames_(chain.link_count()) {
  for (const Reach& reach : reaches) {
    middles_.push_back(reach.middle);
    tracks_.emplace_back(kTolerance_mm, WaitingValues<Placed, PlacedWay>(PlacedWay{reach.radius}));
  }
}

void LinkTracks::add(double t_s, std::span<const double> joints) {
  chain_.displace(joints, frames_);
  const Frame ground = inverse(frames_[base_]);
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    const Frame at = compose(ground, frames_[k]);
    const Vector middle = apply_to_point(at, {middles_[k][0], middles_[k][1], middles_[k][2]});
    const Quaterniond turn = Quaterniond(at.q[0], at.q[1], at.q[2], at.q[3]).normalized();
    tracks_[k].add(t_s, {Vector3d(middle[0], middle[1], middle[2]), turn});
  }
  while (keys() > most_keys_) {
    for (auto& track : tracks_) track.coarsen();
  }
}

void LinkTracks::end() {
  for (auto& track : tracks_) track.end();
}

double LinkTracks::within_mm() const noexcept {
  return tracks_.empty() ? 0 : tracks_.front().within();
}

std::size_t LinkTracks::keys() const noexcept {
  std::size_t count = 0;
  for (const auto& track : tracks_) count += track.keys().size();
  return count;
}

nlohmann::json LinkTracks::to_json(std::size_t link) const {
  nlohmann::json t = nlohmann::json::array(), p = t, q = t;
  for (const auto& [t_s, at] : tracks_[link].keys()) {
    t.push_back(rounded(t_s, kTimeDigits));
    for (int a = 0; a < 3; ++a) p.push_back(rounded(at.middle[a], kPlaceDigits));
    for (const double c : {at.turn.w(), at.turn.x(), at.turn.y(), at.turn.z()}) q.push_back(rounded(c, kTurnDigits));
  }
  const Vector3d& middle = middles_[link];
  return {{"middle", rounded(std::vector{middle[0], middle[1], middle[2]}, kPlaceDigits)},
          {"t", std::move(t)},
          {"p", std::move(p)},
          {"q", std::move(q)}};
}

}  // namespace rmac::cli
