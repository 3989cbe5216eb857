#include "planner/published_plan.hpp"

#include <algorithm>
#include <cmath>

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

bool PublishedPlan::slowed_by(const FeedRule& feed, const PathView& path, double t) const {
  constexpr double kWellBelow = 0.98;
  return std::ranges::any_of(law, [&](const LawPiece& piece) {
    const double fastest = std::max(piece.start.v, piece.at(piece.duration).v);
    return piece.t0 + piece.duration >= t &&
           fastest >= kWellBelow * feed.bound(path.segment(path.find(piece.start.s, 1)));
  });
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

std::unique_ptr<Plan> go_on_as(const PublishedPlan& before, std::int64_t cycle, double leaves_t,
                               const std::vector<LawPiece>& law, double period_s) {
  auto plan = std::make_unique<Plan>();
  const double t_now = static_cast<double>(cycle - before.plan->start_cycle) * period_s;
  const double kept = std::max(leaves_t - t_now, 0.0);
  if (kept > 0) plan->law = before.pieces_between(t_now, leaves_t);
  append_law(plan->law, law, kept);
  plan->start_cycle = cycle;
  plan->latest_cycle = cycle + static_cast<std::int64_t>(std::floor(kept / period_s + 1e-9));
  return plan;
}

void lay_out(Plan& plan, const LaidPath& path, double period_s) {
  const LawPiece &first = plan.law.front(), &last = plan.law.back();
  plan.end_time_s = last.t0 + last.duration;
  const PathView view = path.view();
  // The cycle before may have seen the segment before, whose end the follower still has to count.
  const double s_before = first.start.s - 2 * first.start.v * period_s;
  for (std::size_t i = view.find(s_before, 1); i <= view.find(last.at(last.duration).s, -1); ++i) {
    plan.segments.push_back(path.segment(i));
    plan.segment_start.push_back(path.start(i));
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
