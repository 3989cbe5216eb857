#include "gateway/material/material.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rmac/motion/frame.hpp"

namespace rmac::gateway {
namespace {

using Eigen::Vector3d;

constexpr double kMostTolerance_mm = 0.005, kShareOfResolution = 0.05;
/// Of the tolerance, for what lies between two positions that were looked at; the rest is for these themselves.
constexpr double kShareBetween = 0.25;
/// Of the tolerance: walls that the cutting part left may be off by it, on either side.
constexpr double kToldFrom = 4;
constexpr double kSprings_mm = 1e-5;  ///< a tool that bends no more in a step stands with its joints
constexpr int kMostHalvings = 20;
constexpr std::size_t kTogether = 32;  ///< strokes

double resolution_of(const DexelLayout& layout) {
  return *std::ranges::max_element(layout.pitch);
}

double tolerance_of(const DexelLayout& layout) {
  return std::min(kMostTolerance_mm, kShareOfResolution * resolution_of(layout));
}

}  // namespace

Material::Material(LinkChain chain, DexelGrid grid, const Frame& part_frame, FindingList& findings)
    : chain_(std::move(chain)),
      grid_(std::move(grid)),
      findings_(findings),
      to_part_(inverse(part_frame)),
      part_frame_(part_frame),
      tolerance_mm_(tolerance_of(grid_.layout())),
      within_mm_(resolution_of(grid_.layout())),
      removed_(grid_.volume_mm3()),
      links_(chain_.link_count()) {}

std::string Material::set_tool(const Tool& tool) {
  finish();
  parts_.clear();
  begun_ = false;
  spindle_needed_ = tool.needs_spindle;
  tip_home_ = compose(chain_.interface_home(), tip_on_interface(tool));
  if (!tool.shape) return "";
  const ToolShape& shape = *tool.shape;
  const auto add = [&](const char* what, const std::vector<ProfilePiece>& pieces, bool cuts) {
    const double tolerance = (1 - kShareBetween) * (cuts ? tolerance_mm_ : within_mm_ / 2);
    for (const ProfilePiece& piece : pieces) {
      parts_.push_back({fmt::format("tool {}, {}", tool.number, what), StrokeMaker(piece, tolerance), cuts});
    }
  };
  add("cutting part", cutting_profile(shape), true);
  add("shank", profile_of(shape.shank, shape.lcf, within_mm_), false);
  add("holder", profile_of(shape.holder, shape.holder_begins(tool.length_mm), within_mm_), false);
  const auto thin = [this](const ConeShape& section) {
    return std::max(section.bottom_radius, section.top_radius) <= within_mm_;
  };
  if (std::ranges::none_of(shape.shank, thin) && std::ranges::none_of(shape.holder, thin)) return "";
  return fmt::format(
      "tool {}: its shank or holder is no thicker than the rays are apart ({:g} mm), so that it is not found in "
      "material; give a finer --resolution",
      tool.number, within_mm_);
}

Material::Stand Material::stand(std::span<const double> joints, const Vector3d& bend_mm) {
  chain_.displace(joints, links_);
  const Frame at = compose(to_part_, compose(links_.back(), tip_home_));
  const Vector axis = z_axis(at);
  const ToolAt tool{Vector3d(at.p[0], at.p[1], at.p[2]) + bend_mm, Vector3d(axis[0], axis[1], axis[2]).normalized()};
  return {joints, bend_mm, tool};
}

void Material::advance(double t_s, std::span<const double> joints, const MoveNow& move, bool spindle_turns,
                       const Vector3d& bend_mm) {
  const bool turns = spindle_turns || !spindle_needed_;
  // A stroke is of one move, and cuts as a whole or not at all.
  if (move.id != move_.id || move.line != move_.line || move.cutting != move_.cutting || turns != turns_) finish();
  move_ = move, turns_ = turns;
  const Stand there = stand(joints, bend_mm);
  if (!begun_) {
    for (Part& part : parts_) part.strokes.forget();
    go_to(there.tool);
    s_.since = t_s;
    listening_.told = there.tool;
  } else if (!std::ranges::equal(joints, at_.joints)) {
    tell_listener(t_s, there);
    if (turns_between(at_.joints, joints)) {
      go_between({at_.joints, at_.bend_mm, at_.tool}, there, kMostHalvings);
    } else {
      go_to(there.tool);
    }
  } else if ((bend_mm - at_.bend_mm).norm() > kSprings_mm) {
    go_to(there.tool);
  }
  begun_ = true;
  s_.now = t_s;
  at_.tool = there.tool, at_.bend_mm = bend_mm;
  at_.joints.assign(joints.begin(), joints.end());
}

/// Slides alone leave the way straight.
bool Material::turns_between(std::span<const double> from, std::span<const double> to) const {
  for (std::size_t j = 0; j < from.size(); ++j) {
    if (from[j] != to[j] && chain_.motion(j).turns != 0) return true;
  }
  return false;
}

/// Halves the way of the joints until the tool goes straight on it as far as the tolerance can tell.
void Material::go_between(const Stand& from, const Stand& to, int halvings) {
  std::vector<double> halfway(from.joints.size());
  for (std::size_t j = 0; j < halfway.size(); ++j) halfway[j] = (from.joints[j] + to.joints[j]) / 2;
  const Stand middle = stand(halfway, (from.bend_mm + to.bend_mm) / 2);
  const Vector3d bulge = middle.tool.tip - (from.tool.tip + to.tool.tip) / 2;
  const Vector3d turn = middle.tool.axis - (from.tool.axis + to.tool.axis) / 2;
  const bool straight = std::ranges::all_of(parts_, [&](const Part& part) {
    const double tolerance = part.cuts ? tolerance_mm_ : within_mm_ / 2;
    return (bulge + part.strokes.piece().middle * turn).norm() <= kShareBetween * tolerance &&
           part.strokes.turned_mm(from.tool, to.tool) <= (1 - kShareBetween) * tolerance / 2;
  });
  if (straight || halvings == 0) {
    go_to(to.tool);
    return;
  }
  go_between(from, middle, halvings - 1);
  go_between(middle, to, halvings - 1);
}

void Material::go_to(const ToolAt& there) {
  for (Part& part : parts_) {
    if (const auto stroke = part.strokes.go_to(there)) take(part, *stroke);
  }
}

/// A mean over as long as the listener wants, or as it goes without a rest.
Vector3d Material::velocity(double t_s, const Vector3d& tip) {
  auto& way = listening_.way;
  if (!way.empty() && way.back().first < s_.now) way.clear();  // it stood
  way.emplace_back(t_s, tip);
  const double since_s = t_s - listening_.listener->steady_s();
  while (way.size() > 2 && way[1].first <= since_s) way.pop_front();
  if (way.size() < 2) return (tip - (at_.tool.tip - at_.bend_mm)) / (t_s - s_.now);
  return (tip - way.front().second) / (t_s - way.front().first);
}

void Material::tell_listener(double t_s, const Stand& there) {
  if (listening_.listener == nullptr || !turns_ || t_s <= s_.now) return;
  if (std::ranges::none_of(parts_, &Part::cuts)) return;
  // How it bends is not how it is fed: it would swing with the force that it gives.
  const Vector3d goes = velocity(t_s, there.tool.tip - there.bend_mm);
  if ((there.tool.tip - listening_.told.tip).norm() < listening_.listener->every_mm() || goes.norm() == 0) return;
  listening_.told = there.tool;
  end_strokes(true);
  listening_.listener->cuts(grid_, there.tool, goes, t_s, move_);
}

void Material::finish() {
  end_strokes(true);
  end_strokes(false);
  s_.since = s_.now;
}

void Material::end_strokes(bool cutting) {
  for (Part& part : parts_) {
    if (part.cuts != cutting) continue;
    if (const auto stroke = part.strokes.end()) take(part, *stroke);
  }
  if (cutting) cut_all();
}

void Material::take(Part& part, const Stroke& stroke) {
  const Sweep sweep = sweep_of(part.strokes.piece(), stroke);
  if (!part.cuts) {
    look_at(part, sweep);
    return;
  }
  ++strokes_;
  part.waiting.push_back(sweep);
  if (part.waiting.size() >= kTogether) cut_all();
}

/// Where the tool cuts its side goes first: the upper half of a ball then meets nothing that is not gone.
void Material::cut_all() {
  const auto cut_one = [this](Part& part) {
    if (part.cuts && !part.waiting.empty()) cut_with(part);
  };
  if (turns_ && move_.cutting) {
    std::for_each(parts_.rbegin(), parts_.rend(), cut_one);
  } else {
    std::ranges::for_each(parts_, cut_one);
  }
}

void Material::cut_with(Part& part) {
  const bool may_cut = turns_ && move_.cutting;  // how deep is nobody's concern then
  const Removal met = cut(grid_, part.waiting, may_cut ? Cut::Remove : turns_ ? Cut::RemoveAndTell : Cut::Look);
  part.waiting.clear();
  if (turns_) removed_.add(met);
  if (turns_ && listening_.listener != nullptr) listening_.listener->takes(*std::ranges::max_element(met.volumes_mm3));
  if (!turns_) {
    tell(part, met, "the spindle stands");
  } else if (!move_.cutting) {
    tell(part, met, "positioning move");
  }
}

void Material::look_at(const Part& part, const Sweep& sweep) {
  if (cut(grid_, sweep, Cut::Look).depth_mm <= kToldFrom * tolerance_mm_) return;
  // What the cutting part passed until now is gone, though its stroke is not over.
  end_strokes(true);
  tell(part, cut(grid_, sweep, Cut::Look), "it does not cut");
}

void Material::tell(const Part& part, const Removal& met, const char* why) {
  if (met.depth_mm <= kToldFrom * tolerance_mm_) return;
  Finding* const finding = findings_.of("stock", part.name, s_.since, move_, {.possible = false, .meet = true});
  if (finding == nullptr) return;
  if (finding->why.empty()) finding->why = why;
  const Vector at = apply_to_point(part_frame_, {met.place[0], met.place[1], met.place[2]});
  const Vector3d place(at[0], at[1], at[2]);
  findings_.see(*finding, {.least = 0, .most = 0, .on_first = place, .on_second = place}, met.depth_mm, s_.now, move_);
}

}  // namespace rmac::gateway
