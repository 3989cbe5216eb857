#include "gateway/queue/program_log.hpp"

#include <utility>

namespace rmac::gateway {

ProgramStep step_at(const PathBuilder& builder, StepAsSent what) {
  const auto joints = builder.end_joints();
  return {.what = std::move(what), .start = builder.end_pose(), .start_joints = {joints.begin(), joints.end()}};
}

void ProgramLog::add(ProgramStep step, std::size_t left) {
  moves_ += step.counts;
  steps_.push_back(std::move(step));
  keep(left);
}

void ProgramLog::keep(std::size_t left) {
  while (!steps_.empty() && moves_ - steps_.front().counts >= left) {
    moves_ -= steps_.front().counts;
    steps_.pop_front();
  }
}

void ProgramLog::clear() noexcept {
  steps_.clear();
  moves_ = 0;
}

std::deque<ProgramStep> ProgramLog::take() noexcept {
  moves_ = 0;
  return std::exchange(steps_, {});
}

}  // namespace rmac::gateway
