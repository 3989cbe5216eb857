#include "gateway/cycle/output_marks.hpp"

namespace rmac::gateway {

void OutputMarks::add(std::uint64_t after_moves, const SwitchOutputs& outputs) {
  marks_.push_back({++last_, after_moves, outputs.mask, outputs.values});
  hand_on();
}

void OutputMarks::hand_on() {
  while (handed_ < marks_.size() && ahead_.push(marks_[handed_])) ++handed_;
}

void OutputMarks::settle(std::uint64_t passed) {
  if (!marks_.empty() && marks_.front().number <= passed) {
    wishes_.change([&](ServoWishes& wishes) {
      for (; !marks_.empty() && marks_.front().number <= passed; marks_.pop_front(), --handed_) {
        const OutputMark& mark = marks_.front();
        wishes.outputs = (wishes.outputs & ~mark.mask) | (mark.values & mark.mask);
      }
      wishes.marks_settled = passed;
    });
  }
  hand_on();
}

void OutputMarks::drop() {
  marks_.clear();
  handed_ = 0;
  if (wishes_.now().marks_settled == last_) return;
  wishes_.change([&](ServoWishes& wishes) { wishes.marks_settled = last_; });
}

}  // namespace rmac::gateway
