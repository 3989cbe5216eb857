#include "gateway/learning/pass.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rmac::gateway {
namespace {

/// Less than this is standing still, mm or degrees.
constexpr double kStanding = 1e-9;
constexpr double kSamePlace = 1e-3;
/// Of a joint, in a cycle.
constexpr double kJointStands = 1e-7;

}  // namespace

Pass::Pass(std::vector<int> answer_delays)
    : delays_(std::move(answer_delays)), errors_(delays_.size()), moves_(delays_.size()) {}

void Pass::add(const Row& row) {
  if (row.position_set.size() < joints() || row.following_error.size() < joints()) return;
  if (last_cycle_ >= 0 && row.cycle > last_cycle_ + 1) missing_ += row.cycle - last_cycle_ - 1;
  last_cycle_ = row.cycle;
  for (std::size_t j = 0; j < joints(); ++j) {
    const auto delay = static_cast<std::size_t>(delays_[j]);
    errors_[j].push_back(0);
    moves_[j].push_back(!last_.empty() && std::abs(row.position_set[j] - last_[j]) > kJointStands);
    if (delay <= cycles_) errors_[j][cycles_ - delay] = row.following_error[j];
  }
  last_.assign(row.position_set.begin(), row.position_set.end());
  if (cycles_ == 0) first_ = last_;
  note_step(row);
  ++cycles_;
}

void Pass::note_step(const Row& row) {
  if (!row.moving) return;
  if (!steps_.empty()) {
    const Step& before = steps_.back();
    if (row.move_id == before.move_id && !(row.s_mm > before.s_mm + kStanding)) {
      went_back_ = went_back_ || row.s_mm < before.s_mm - kSamePlace;
      return;
    }
    if (row.move_id != before.move_id) passed_.insert(before.move_id);
    if (passed_.contains(row.move_id)) went_back_ = true;
  }
  steps_.push_back({cycles_, row.move_id, row.s_mm, 0});
}

void Pass::end() {
  lay_out();
}

void Pass::lay_out() {
  double begin = 0;
  std::vector<Step> laid;
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    Step step = steps_[i];
    if (!laid.empty() && step.move_id != laid.back().move_id) {
      // The border of two moves is between two cycles: the way across it is as long as the ways beside it.
      const auto way = [&](std::size_t from) {
        const bool within = from + 1 < steps_.size() && steps_[from].move_id == steps_[from + 1].move_id;
        return within ? steps_[from + 1].s_mm - steps_[from].s_mm : -1;
      };
      const double before = i >= 2 ? way(i - 2) : -1, behind = way(i);
      const double across = before < 0 ? behind : behind < 0 ? before : 0.5 * (before + behind);
      begin = laid.back().along_mm + std::max(across - step.s_mm, 0.0);
    }
    step.along_mm = begin + step.s_mm;
    if (laid.empty() || step.along_mm > laid.back().along_mm + kStanding) laid.push_back(step);
  }
  steps_ = std::move(laid);
}

double Pass::rms(std::size_t joint) const {
  double sum = 0;
  std::size_t count = 0;
  for (const Step& step : steps_) {
    if (!moves(joint, step.cycle)) continue;
    sum += error(joint, step.cycle) * error(joint, step.cycle);
    ++count;
  }
  return count == 0 ? 0 : std::sqrt(sum / static_cast<double>(count));
}

double Pass::largest(std::size_t joint) const {
  double largest = 0;
  for (const Step& step : steps_) {
    if (moves(joint, step.cycle)) largest = std::max(largest, std::abs(error(joint, step.cycle)));
  }
  return largest;
}

bool Pass::closed() const {
  for (std::size_t j = 0; j < joints() && j < first_.size(); ++j) {
    if (std::abs(first_[j] - last_[j]) > kSamePlace) return false;
  }
  return true;
}

}  // namespace rmac::gateway
