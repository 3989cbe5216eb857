#include "gateway/learning/learner.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "gateway/learning/zero_phase.hpp"

namespace rmac::gateway {
namespace {

/// A pass is worse than another one if it is by so much: what does not repeat makes as much of a difference.
constexpr double kWorse = 1.03;
constexpr double kKnotsPerPeriod = 8;  ///< of the highest frequency that is learned
constexpr double kMostSlower = 8;      ///< a joint that comes out worse again and again
constexpr double kFade_s = 0.01;       ///< offsets begin and end with 0

/// From 0 to 1, without a step of its slope.
double risen(double share) {
  const double u = std::clamp(share, 0.0, 1.0);
  return u * u * (3 - 2 * u);
}

}  // namespace

Learner::Learner(Options options) : options_(std::move(options)) {
  for (std::size_t j = 0; j < options_.largest.size(); ++j) {
    joints_.push_back({.bandwidth_hz = options_.bandwidth_hz, .gain = options_.gain});
  }
}

std::vector<double> Learner::offsets_of(const LearnedPath* path, const Pass& pass, std::size_t joint) const {
  std::vector<double> offsets(pass.steps().size());
  if (path == nullptr) return offsets;
  LearnedPath::Cursor cursor;
  std::vector<double> all(path->joints());
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const Pass::Step& step = pass.steps()[i];
    if (path->at(cursor, step.move_id, step.s_mm, all)) offsets[i] = all[joint];
  }
  return offsets;
}

std::vector<double> Learner::improved(const Pass& pass, std::size_t joint) const {
  const auto& steps = pass.steps();
  const Joint& how = joints_[joint];
  const std::vector<double> offsets = offsets_of(next_.get(), pass, joint);
  const auto lead = static_cast<std::size_t>(std::lround(options_.lead_s / options_.period_s));
  // A joint that came out worse learns less of higher frequencies, and keeps what it knew of them.
  const bool adds = how.bandwidth_hz < options_.bandwidth_hz;
  std::vector<double> learned(steps.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (!pass.moves(joint, steps[i].cycle)) continue;
    learned[i] = how.gain * pass.error(joint, steps[i].cycle + lead) + (adds ? 0 : offsets[i]);
  }
  filter_zero_phase(learned, how.bandwidth_hz, options_.period_s);
  if (adds) std::ranges::transform(learned, offsets, learned.begin(), std::plus());
  // An approach from elsewhere is not gone again.
  std::size_t first = 0;
  while (!pass.closed() && first < steps.size() && steps[first].move_id == steps.front().move_id) ++first;
  const double fade = kFade_s / options_.period_s;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double since = static_cast<double>(i) - static_cast<double>(first);
    const double left = static_cast<double>(steps.size() - 1 - i);
    learned[i] *= risen(since / fade) * risen(left / fade);
    learned[i] = std::clamp(learned[i], -options_.largest[joint], options_.largest[joint]);
  }
  return learned;
}

void Learner::learn(const Pass& pass) {
  std::vector<std::vector<double>> offsets;
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    Joint& joint = joints_[j];
    const double rms = pass.rms(j);
    if (passes_ > 0 && rms > kWorse * joint.best_rms) {
      joint.fell_back = true;
      joint.gain = std::max(joint.gain / 2, options_.gain / kMostSlower);
      joint.bandwidth_hz = std::max(joint.bandwidth_hz / 2, options_.bandwidth_hz / kMostSlower);
      offsets.push_back(offsets_of(joint.best.get(), pass, j));
      continue;
    }
    if (passes_ == 0 || rms < joint.best_rms) {
      joint.best_rms = rms;
      joint.best_pass = passes_;
      joint.best = next_;
    }
    offsets.push_back(improved(pass, j));
  }
  ++passes_;
  lay(pass, offsets);
}

void Learner::settle(const Pass& last) {
  std::vector<std::vector<double>> offsets;
  for (std::size_t j = 0; j < joints_.size(); ++j) offsets.push_back(offsets_of(joints_[j].best.get(), last, j));
  lay(last, offsets);
}

void Learner::lay(const Pass& pass, const std::vector<std::vector<double>>& offsets) {
  const auto& steps = pass.steps();
  parts_ = {};
  parts_.joints = joints_.size();
  const double per_knot = 1 / (kKnotsPerPeriod * options_.bandwidth_hz * options_.period_s);
  const auto stride = static_cast<std::size_t>(std::max(1.0, std::floor(per_knot)));
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (parts_.moves.empty() || parts_.moves.back().id != steps[i].move_id) {
      parts_.moves.push_back({steps[i].move_id, parts_.moves.empty() ? 0 : steps[i].along_mm - steps[i].s_mm});
    }
    if (i % stride != 0 && i + 1 != steps.size()) continue;
    parts_.places.push_back(steps[i].along_mm);
    // Between knots that stand at the bound their cubic goes beyond it.
    for (std::size_t j = 0; j < offsets.size(); ++j)
      parts_.offsets.push_back(std::clamp(offsets[j][i], -options_.largest[j], options_.largest[j]));
  }
  if (!steps.empty()) parts_.end_mm = steps.back().along_mm;
  auto made = LearnedPath::create(parts_);
  problem_ = made ? std::string() : made.error().message;
  next_ = made ? std::make_shared<const LearnedPath>(std::move(*made)) : nullptr;
}

}  // namespace rmac::gateway
