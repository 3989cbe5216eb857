#include "gateway/cutting/cutting_load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rmac::gateway {
namespace {

/// Of the tool's diameter: how far it goes until its engagement is looked at again, unless rays are farther apart.
constexpr double kShareOfDiameter = 0.05;
constexpr double kUnknownTool_mm = 1;
/// So often on end is material to go, and so much, unseen, before it is told.
constexpr int kBlindLooks = 3;
constexpr double kLeastTaken_mm3 = 1e-3;
/// Feeds that differ by less need no new forces.
constexpr double kSameFeed = 0.002;
/// Of its speed: a tool that goes across its axis by less goes along it.
constexpr double kStraightDown = 1e-6;
/// A tooth that goes down by less with its face cuts no chip: that is no more than edges are sharp, and axes give way.
constexpr double kSharp_mm = 0.002;
/// Nor does one that gives way as a cut begins: less than 6° down, for so many looks on end.
constexpr double kPlunge = 0.1;
constexpr int kGivesWayLooks = 4;
constexpr double kLongestTurn_s = 0.05;

bool same(const std::vector<EngagedSlice>& a, const std::vector<EngagedSlice>& b) {
  return std::ranges::equal(a, b, [](const EngagedSlice& one, const EngagedSlice& other) {
    return one.from_mm == other.from_mm && one.to_mm == other.to_mm && one.arcs == other.arcs;
  });
}

void add(CuttingShare& share, const TurnForces& forces, double time_s) {
  const double all_s = share.time_s + time_s;
  const auto mean = [&](double& of, double now) { of = (of * share.time_s + now * time_s) / all_s; };
  mean(share.mean_n, forces.total_n.mean);
  mean(share.mean_nm, forces.torque_nm.mean);
  mean(share.mean_w, forces.power_w.mean);
  share.time_s = all_s;
  share.peak_n = std::max(share.peak_n, forces.total_n.peak);
  share.peak_nm = std::max(share.peak_nm, forces.torque_nm.peak);
  share.peak_w = std::max(share.peak_w, forces.power_w.peak);
}

/// Of a tool that goes by `velocity`; 0 without a way across its axis.
Eigen::Vector3d across(const Eigen::Vector3d& axis, const Eigen::Vector3d& velocity) {
  const Eigen::Vector3d way = velocity - velocity.dot(axis) * axis;
  return way.norm() > kStraightDown * velocity.norm() ? way.normalized() : Eigen::Vector3d::Zero();
}

/// Where nothing goes across the axis, there is no force across it either.
Eigen::Vector3d mean_force(const TurnForces& forces, const Eigen::Vector3d& axis, const Eigen::Vector3d& x) {
  return forces.x_n.mean * x + forces.y_n.mean * axis.cross(x) + forces.z_n.mean * axis;
}

}  // namespace

void CuttingLoad::set_tool(const Tool& tool) {
  tool_ = tool.number;
  mill_.reset();
  last_.reset();
  now_until_s_ = -1;
  looks_ = {};
  no_mill_.clear();
  if (!tool.shape) return;  // it takes nothing away
  auto mill = EndMill::of(*tool.shape);
  if (mill) {
    mill_ = *mill;
  } else {
    no_mill_ = mill.error().message;
  }
}

double CuttingLoad::every_mm() const {
  return std::max(2 * rays_mm_, mill_ ? kShareOfDiameter * 2 * mill_->radius_mm() : kUnknownTool_mm);
}

double CuttingLoad::steady_s() const {
  return rpm_ != 0 ? std::min(60 / std::abs(rpm_), kLongestTurn_s) : 0;
}

void CuttingLoad::miss(const char* kind, const std::string& sentence) {
  if (!missed_.insert(fmt::format("{} {}", kind, tool_)).second) return;
  not_told_.insert(fmt::format("forces of tool {}: {}", tool_, sentence));
}

void CuttingLoad::cuts(const DexelGrid& grid, const ToolAt& tool, const Eigen::Vector3d& velocity, double t_s,
                       const MoveNow& move) {
  const double speed = velocity.norm(), every_s = every_mm() / speed;
  const double time_s = std::min(t_s - looks_.told_s, 2 * every_s), before_s = std::exchange(looks_.told_s, t_s);
  now_until_s_ = -1;
  if (!mill_) {
    if (!no_mill_.empty()) miss("teeth", no_mill_);
    return;
  }
  Engagement met = engagement_of(*mill_, grid, tool, velocity, every_mm() / 2);
  const double teeth_s = mill_->teeth() * std::abs(rpm_) / 60, along = velocity.dot(tool.axis);
  if (plunges(met, teeth_s > 0 ? -along / teeth_s : -along, -along / speed)) {
    miss("face", fmt::format("it goes down into material with the face of its flat end, first in line {}; what that "
                             "takes is not in them",
                             move.line));
  }
  if (!engaged(met, move)) return;
  if (rpm_ < 0) {
    miss("turns", fmt::format("it turns to the left, and its teeth are taken for those of a right-hand cutter, first "
                              "in line {}",
                              move.line));
    return;
  }
  if (!(rpm_ > 0)) {
    miss("speed", fmt::format("how fast it turns is not known, first in line {}", move.line));
    return;
  }
  const ToothFeed feed{.across_mm = (velocity - along * tool.axis).norm() / teeth_s, .along_mm = along / teeth_s};
  const double most = kSameFeed * speed / teeth_s;
  if (!last_ || last_->rpm != rpm_ || std::abs(last_->feed.across_mm - feed.across_mm) > most ||
      std::abs(last_->feed.along_mm - feed.along_mm) > most || !same(last_->slices, met.slices)) {
    auto forces = forces_over_turn(*mill_, material_.coefficients, met.slices, feed, rpm_);
    if (!forces) {
      miss("refused", fmt::format("{}, first in line {}", forces.error().message, move.line));
      return;
    }
    last_ = Last{.slices = std::move(met.slices), .feed = feed, .rpm = rpm_, .forces = *forces};
  }
  const Eigen::Vector3d goes = across(tool.axis, velocity);
  now_ = {last_->forces.total_n.mean, last_->forces.torque_nm.mean, last_->forces.power_w.mean,
          mean_force(last_->forces, tool.axis, goes), tool.axis};
  now_until_s_ = t_s + 2 * every_s;
  add(all_, last_->forces, time_s);
  add(moves_[move.id], last_->forces, time_s);
  judge(Overload::Of::Torque, last_->forces.torque_nm.mean, spindle_.torque_nm, {before_s, t_s}, tool, move);
  judge(Overload::Of::Power, last_->forces.power_w.mean, spindle_.power_w, {before_s, t_s}, tool, move);
  if (listener_ != nullptr) listener_->engaged({*mill_, last_->slices, feed, rpm_, tool, goes, t_s, move});
}

bool CuttingLoad::plunges(const Engagement& met, double down_mm, double share) {
  looks_.down = met.face && down_mm >= kSharp_mm ? looks_.down + 1 : 0;
  return looks_.down >= kGivesWayLooks || (looks_.down > 0 && share > kPlunge);
}

bool CuttingLoad::engaged(const Engagement& met, const MoveNow& move) {
  const double taken = std::exchange(looks_.taken_mm3, 0);
  if (!met.slices.empty() || met.face || taken < kLeastTaken_mm3) {
    looks_.blind = 0;
    return !met.slices.empty();
  }
  // A look or two may fall beside the last of a cut.
  if (++looks_.blind == kBlindLooks) {
    miss("rays", fmt::format("it takes off less than rays {:g} mm apart show, first in line {}; give a finer "
                             "--resolution",
                             rays_mm_, move.line));
  }
  return false;
}

void CuttingLoad::judge(Overload::Of of, double mean, double allowed, const Span& span, const ToolAt& tool,
                        const MoveNow& move) {
  if (allowed <= 0) return;
  most_used_ = std::max(most_used_, mean / allowed);
  if (mean <= allowed) return;
  const auto under_way = std::ranges::find_if(overloads_.rbegin(), overloads_.rend(), [&](const Overload& each) {
    return each.of == of && (each.until_s >= span.from_s || each.move_id == move.id);
  });
  if (under_way == overloads_.rend() && overloads_.size() >= kMostOverloads) return;
  Overload& overload =
      under_way != overloads_.rend()
          ? *under_way
          : overloads_.emplace_back(Overload{.of = of, .line = move.line, .move_id = move.id, .t_s = span.to_s});
  overload.until_s = span.to_s;
  if (mean <= overload.most) return;
  overload.most = mean, overload.allowed = allowed, overload.place = tool.tip;
}

}  // namespace rmac::gateway
