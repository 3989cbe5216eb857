#include "planner/published_plan.hpp"

#include <algorithm>

namespace rmac {

double PublishedPlan::end_s() const {
  const LawPiece& last = law.back();
  return last.at(last.duration).s;
}

PathState PublishedPlan::state_at(double t) const {
  if (t >= plan->end_time_s) return {end_s(), 0, 0};
  auto piece =
      std::upper_bound(law.begin(), law.end(), t, [](double value, const LawPiece& x) { return value < x.t0; });
  if (piece != law.begin()) --piece;
  return piece->at(std::max(t - piece->t0, 0.0));
}

std::vector<LawPiece> PublishedPlan::pieces_between(double t_begin, double t_end) const {
  std::vector<LawPiece> kept;
  for (LawPiece piece : law) {
    const double end = piece.t0 + piece.duration;
    if (end <= t_begin || piece.t0 >= t_end) continue;
    if (end > t_end) piece.duration = t_end - piece.t0;
    piece.t0 -= t_begin;
    kept.push_back(piece);
  }
  return kept;
}

double PublishedPlan::time_at(double s) const {
  const auto piece = std::find_if(law.begin(), law.end(), [&](const LawPiece& x) { return x.start.s >= s; });
  return piece == law.end() ? plan->end_time_s : piece->t0;
}

void PublishedPlan::move_origin(double distance_mm) {
  for (LawPiece& piece : law) piece.start.s -= distance_mm;
}

void append_law(std::vector<LawPiece>& law, const std::vector<LawPiece>& tail, double t0) {
  for (LawPiece piece : tail) {
    piece.t0 += t0;
    law.push_back(piece);
  }
}

double commit_time(const Plan& plan, double window_begin, double planned_again) {
  const auto& law = plan.law;
  const LawPiece& last = law.back();
  const double s_end = last.at(last.duration).s;
  const double s_commit = s_end - std::min(planned_again, 0.5 * (s_end - window_begin));
  double t = plan.end_time_s;
  for (std::size_t i = law.size(); i-- > 0;) {
    t = law[i].t0;
    if (law[i].start.s <= s_commit) break;
  }
  return t;
}

}  // namespace rmac
