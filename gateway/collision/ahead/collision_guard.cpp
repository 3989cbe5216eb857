#include "gateway/collision/ahead/collision_guard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "gateway/collision/ahead/clear_way.hpp"
#include "rmac/motion/move_name.hpp"

namespace rmac::gateway {

struct CollisionGuard::Question {
  std::shared_ptr<const PathSegment> segment;
  std::shared_ptr<ClearWay> way;
  std::shared_ptr<const Tool> tool;
  bool anew = false;  ///< it begins anywhere
  ClearWay::Checked checked{};
  double told_to = 0;
  [[nodiscard]] bool done() const noexcept { return checked.whole || checked.obstacle; }
};

CollisionGuard::CollisionGuard(bool in_thread) : in_thread_(in_thread) {}

CollisionGuard::~CollisionGuard() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
    questions_.clear();
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void CollisionGuard::put_in(std::shared_ptr<ClearWay> way) {
  forget();
  way_ = std::move(way);
  on_ = way_ != nullptr;
  {
    const std::lock_guard lock(mutex_);
    remarked_.clear();
  }
  if (on_ && in_thread_ && !thread_.joinable()) thread_ = std::thread([this] { look(); });
}

void CollisionGuard::ask(std::shared_ptr<const PathSegment> segment) {
  auto question = std::make_shared<Question>();
  question->segment = std::move(segment);
  question->way = way_;
  question->tool = tool_;
  question->anew = std::exchange(anew_, false);
  const std::lock_guard lock(mutex_);
  questions_.push_back(std::move(question));
  wake_.notify_one();
}

PathGate::Answer CollisionGuard::answer() {
  std::unique_lock lock(mutex_);
  if (questions_.empty()) return {};
  Question& first = *questions_.front();
  if (!in_thread_ && !first.done()) {
    lock.unlock();
    look_at(first);
    lock.lock();
  }
  if (first.checked.obstacle) {
    obstacle_ = first.checked.obstacle;
    return {Answer::Kind::Blocks, first.checked.clear_to};
  }
  if (first.checked.whole) {
    questions_.pop_front();
    return {Answer::Kind::Passes, 0};
  }
  if (first.checked.clear_to <= first.told_to) return {};
  first.told_to = first.checked.clear_to;
  return {Answer::Kind::Part, first.told_to};
}

void CollisionGuard::forget() {
  const std::lock_guard lock(mutex_);
  questions_.clear();
  obstacle_.reset();
  anew_ = true;
}

void CollisionGuard::wait_until_idle() {
  std::unique_lock lock(mutex_);
  idle_.wait(lock, [this] { return !looks_; });
}

std::vector<std::string> CollisionGuard::take_remarks() {
  if (!on_) return {};
  const std::lock_guard lock(mutex_);
  return std::exchange(remarks_, {});
}

void CollisionGuard::look() noexcept {
  std::unique_lock lock(mutex_);
  while (!ends_) {
    const auto next = std::ranges::find_if(questions_, [](const auto& question) { return !question->done(); });
    const bool blocked = next != questions_.begin() && (*std::prev(next))->checked.obstacle;
    if (next == questions_.end() || blocked) {
      wake_.wait(lock);
      continue;
    }
    std::shared_ptr<Question> question = *next;
    looks_ = true;
    lock.unlock();
    look_at(*question);
    question.reset();
    lock.lock();
    looks_ = false;
    idle_.notify_all();
  }
}

void CollisionGuard::look_at(Question& question) {
  ClearWay& way = *question.way;
  if (question.anew && question.checked.clear_to == 0) {
    way.begin();
    if (way_looked_at_ != question.way || tool_looked_at_ != question.tool) {
      way.set_tool(question.tool ? *question.tool : Tool{.number = kNoTool});
    }
    way_looked_at_ = question.way;
    tool_looked_at_ = question.tool;
  }
  const bool cut_before = way.stock_cut();
  ClearWay::Checked checked = way.check(*question.segment, question.checked.clear_to);
  const std::lock_guard lock(mutex_);
  question.checked = std::move(checked);
  remark(question.tool.get());
  if (!cut_before && way.stock_cut()) {
    remark_on(
        fmt::format("behind {} the stock is not checked any more: something was cut from it, and what is left is "
                    "not followed here",
                    move_name(question.segment->stretches().back().move_id)));
  }
}

void CollisionGuard::remark(const Tool* tool) {
  if (tool == nullptr) {
    remark_on("which tool is in the spindle is not known: what moves now is checked without one");
  } else if (tool->number != kNoTool && !tool->shape) {
    remark_on(
        fmt::format("tool {} has no Shape in the tool table: what moves with it is checked without it", tool->number));
  }
}

void CollisionGuard::remark_on(const std::string& what) {
  if (std::ranges::find(remarked_, what) != remarked_.end()) return;
  remarked_.push_back(what);
  remarks_.push_back(what);
}

}  // namespace rmac::gateway
