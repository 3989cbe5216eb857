#include "gateway/rmac/view/link_tracks.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>

#include "gateway/bodies/link.hpp"
#include "gateway/threads/sanitized.hpp"
#include "rmac/modules/chain_kinematics.hpp"
#include "rmac/motion/frame.hpp"

namespace rmac::cli {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Joints = std::array<double, 5>;

constexpr double kCradle_mm = -60;  ///< height of the line about which A turns
constexpr std::size_t kBase = 2;
const std::vector<std::string> kChain{"C", "A", "base", "X", "Y", "Z"};

/// A turntable C on a cradle A under a spindle that X, Y and Z carry.
gateway::LinkChain trunnion() {
  const std::vector<modules::ScrewAxis> axes{{JointType::Linear, {1, 0, 0}, {}},
                                             {JointType::Linear, {0, 1, 0}, {}},
                                             {JointType::Linear, {0, 0, 1}, {}},
                                             {JointType::Rotary, {1, 0, 0}, {0, 0, kCradle_mm}},
                                             {JointType::Rotary, {0, 0, 1}, {}}};
  const modules::ChainKinematics kinematics{axes, {4, 3, 0, 1, 2}, Frame{}};
  const std::vector<std::string> names{"X", "Y", "Z", "A", "C"};
  return gateway::LinkChain::make(kinematics, kChain, names, std::vector<std::pair<double, double>>(5, {-200, 200}))
      .value();
}

/// By hand, as somebody sees it who stands on the ground: the table turns by -C on the cradle, and that by -A.
Isometry3d seen_from_ground(std::size_t link, const Joints& q) {
  constexpr double kRad = std::numbers::pi / 180;
  Isometry3d at = Isometry3d::Identity();
  if (link > kBase) {
    for (std::size_t j = 0; j < link - kBase; ++j) at.translation()[static_cast<Eigen::Index>(j)] = q[j];
    return at;
  }
  if (link <= 1) {
    at.translate(Vector3d(0, 0, kCradle_mm));
    at.rotate(Eigen::AngleAxisd(-q[3] * kRad, Vector3d::UnitX()));
    at.translate(Vector3d(0, 0, -kCradle_mm));
  }
  if (link == 0) at.rotate(Eigen::AngleAxisd(-q[4] * kRad, Vector3d::UnitZ()));
  return at;
}

/// A link's place by its keys alone, with straight ways and turns between them.
Isometry3d shown(const nlohmann::json& link, double t_s) {
  const auto times = link["t"].get<std::vector<double>>(), p = link["p"].get<std::vector<double>>(),
             q = link["q"].get<std::vector<double>>(), middle = link["middle"].get<std::vector<double>>();
  const auto after = static_cast<std::size_t>(std::ranges::upper_bound(times, t_s) - times.begin());
  const std::size_t j = std::min(after, times.size() - 1), i = after == 0 ? 0 : after - 1;
  const double share = j == i ? 0 : (t_s - times[i]) / (times[j] - times[i]);
  const auto place = [&](std::size_t k) { return Vector3d(p[3 * k], p[3 * k + 1], p[3 * k + 2]); };
  const auto turn = [&](std::size_t k) {
    return Eigen::Quaterniond(q[4 * k], q[4 * k + 1], q[4 * k + 2], q[4 * k + 3]).normalized();
  };
  Isometry3d at = Isometry3d::Identity();
  at.translate(Vector3d(place(i) + share * (place(j) - place(i))));
  at.rotate(turn(i).slerp(share, turn(j)));
  at.translate(-Vector3d(middle[0], middle[1], middle[2]));
  return at;
}

std::vector<std::pair<double, Joints>> wander(unsigned seed, std::size_t count, double jitter) {
  std::mt19937_64 random(seed);
  Joints rate{}, q{};
  std::vector<std::pair<double, Joints>> way;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < q.size(); ++j) {
      if (random() % 50 == 0) rate[j] = static_cast<double>(random() % 5) - 2;
      q[j] += rate[j] + std::uniform_real_distribution<double>(-jitter, jitter)(random);
    }
    way.emplace_back(static_cast<double>(i) / 60, q);
  }
  return way;
}

/// The farthest that a place within a link's reach is shown from where it is.
double worst(const LinkTracks& tracks, const std::vector<std::pair<double, Joints>>& way,
             const std::vector<Reach>& reaches) {
  double found = 0;
  for (std::size_t link = 0; link < reaches.size(); ++link) {
    const nlohmann::json kept = tracks.to_json(link);
    for (const auto& [t_s, q] : way) {
      const Isometry3d is = seen_from_ground(link, q), drawn = shown(kept, t_s);
      for (const Vector3d& aside : {Vector3d::UnitX().eval(), Vector3d::UnitY().eval(), Vector3d::UnitZ().eval()}) {
        const Vector3d point = reaches[link].middle + reaches[link].radius * aside;
        found = std::max(found, (is * point - drawn * point).norm());
      }
    }
  }
  return found;
}

const std::vector<Reach> kReaches{{{0, 0, -100}, 120}, {{0, 0, -150}, 200},  {{0, 0, -400}, 900},
                                  {{0, 400, 0}, 500},  {{0, 200, 400}, 400}, {{0, 0, 100}, 300}};
constexpr double kRounding_mm = 0.003;  ///< of what the page has: 1 µm, and 1e-6 in a quaternion

// Red when a turn has the wrong sense, links stand on each other in another order, or keys are left out that count.
TEST(LinkTracks, HoldsEveryPlaceOfEveryLinkAsSeenFromTheGround) {
  for (unsigned seed = 1; seed <= (kSanitized ? 1 : 5); ++seed) {
    const gateway::LinkChain chain = trunnion();
    LinkTracks tracks(chain, kBase, kReaches);
    const auto way = wander(seed, 1500, 0);
    for (const auto& [t_s, q] : way) tracks.add(t_s, q);
    tracks.end();
    EXPECT_LE(worst(tracks, way, kReaches), tracks.within_mm() + kRounding_mm) << "seed " << seed;
    EXPECT_DOUBLE_EQ(tracks.within_mm(), LinkTracks::kTolerance_mm);
    EXPECT_LT(tracks.keys(), way.size() * kReaches.size() / 2);
  }
}

// Red when the number of keys is not bounded, or when what that costs is not told.
TEST(LinkTracks, IsCoarserAndSaysSoWhereAProgramIsTooLong) {
  constexpr std::size_t kMost = 2000;
  const gateway::LinkChain chain = trunnion();
  LinkTracks tracks(chain, kBase, kReaches, kMost);
  const auto way = wander(7, 3000, 0.3);
  std::size_t most = 0;
  for (const auto& [t_s, q] : way) {
    tracks.add(t_s, q);
    most = std::max(most, tracks.keys());
  }
  tracks.end();
  EXPECT_LE(most, kMost);
  EXPECT_GT(tracks.keys(), kMost / 20) << "so coarse it need not be";
  EXPECT_GT(tracks.within_mm(), LinkTracks::kTolerance_mm);
  EXPECT_LE(worst(tracks, way, kReaches), tracks.within_mm() + kRounding_mm);
}

}  // namespace
}  // namespace rmac::cli
