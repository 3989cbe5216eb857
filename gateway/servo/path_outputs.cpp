#include "gateway/servo/path_outputs.hpp"

#include <algorithm>

namespace rmac::gateway {
namespace {

std::uint64_t switched(std::uint64_t outputs, const OutputMark& mark) noexcept {
  return (outputs & ~mark.mask) | (mark.values & mark.mask);
}

}  // namespace

std::uint64_t PathOutputs::step(std::uint64_t wished, std::uint64_t settled, std::uint64_t moves_done) noexcept {
  for (;;) {
    OutputMark mark;
    if (!next_ && ahead_.pop(mark)) next_ = mark;
    if (!next_) break;
    if (next_->number > settled) {
      if (next_->after_moves > moves_done) break;
      pass(*next_);
    }
    next_.reset();
  }
  const auto begin = unsettled_.begin();
  const auto end = begin + static_cast<std::ptrdiff_t>(count_);
  const auto kept = std::find_if(begin, end, [settled](const OutputMark& mark) { return mark.number > settled; });
  count_ = static_cast<std::size_t>(std::move(kept, end, begin) - begin);
  for (std::size_t i = 0; i < count_; ++i) wished = switched(wished, unsettled_[i]);
  return wished;
}

void PathOutputs::pass(const OutputMark& mark) noexcept {
  passed_ = mark.number;
  if (count_ < unsettled_.size()) {
    unsettled_[count_++] = mark;
    return;
  }
  // Whoever settles them is late: the two oldest become one.
  OutputMark& second = unsettled_[1];
  second.values = switched(unsettled_[0].values & unsettled_[0].mask, second);
  second.mask |= unsettled_[0].mask;
  std::move(unsettled_.begin() + 1, unsettled_.end(), unsettled_.begin());
  unsettled_.back() = mark;
}

}  // namespace rmac::gateway
