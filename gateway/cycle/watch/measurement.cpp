#include "gateway/cycle/watch/measurement.hpp"

namespace rmac::gateway {

void Measurement::begin(std::size_t steps) noexcept {
  phase_ = Phase::Approach;
  steps_ = steps;
}

void Measurement::retract() noexcept {
  phase_ = Phase::Retract;
  steps_ = 1;
}

Measurement::Verdict Measurement::search(const Seen& seen, bool hit) noexcept {
  const bool over = seen.moves_left == 0 && seen.at_rest;
  // Before the search moves, and while it is held, what touches is not the part.
  if (hit && (over || !seen.at_rest)) {
    phase_ = Phase::Touched;
    return Verdict::Touched;
  }
  if (!over && seen.probe.ready) return Verdict::Nothing;
  phase_ = Phase::None;
  return over ? Verdict::NotFound : Verdict::ProbeLost;
}

Measurement::Verdict Measurement::step(const Seen& seen) noexcept {
  const bool hit = seen.probe.hits != hits_;
  hits_ = seen.probe.hits;
  if (phase_ == Phase::Approach && seen.moves_left <= 1) {
    phase_ = Phase::Search;
    steps_ = 1;
  }
  if ((phase_ == Phase::Approach || phase_ == Phase::Search) && seen.probe.touching && !hit && !seen.at_rest) {
    phase_ = Phase::None;
    return Verdict::NotArmed;
  }
  switch (phase_) {
    case Phase::Search:
      return search(seen, hit);
    case Phase::Touched:
      if (seen.at_rest) phase_ = Phase::Standing;
      return Verdict::Nothing;
    case Phase::Retract:
      if (seen.moves_left == 0 && seen.at_rest) {
        phase_ = Phase::None;
        return seen.probe.touching ? Verdict::StillTouching : Verdict::Done;
      }
      break;
    case Phase::None:
    case Phase::Approach:
    case Phase::Standing:
      break;
  }
  if (!hit || seen.at_rest) return Verdict::Nothing;
  if (by_hand_ && phase_ == Phase::None) return Verdict::Touched;
  phase_ = Phase::None;
  return Verdict::Unexpected;
}

}  // namespace rmac::gateway
