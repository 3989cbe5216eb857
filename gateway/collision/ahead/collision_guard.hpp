#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "gateway/collision/ahead/obstacle.hpp"
#include "gateway/tools/tool.hpp"
#include "rmac/motion/ports/path_gate.hpp"

namespace rmac::gateway {

class ClearWay;

/// Holds the path against the bodies of the machine, its tool and a set-up, before it is planned. In a thread of its
/// own, which has no lock of the machine's; without one, as the planner asks. Whoever has the machine's turn calls it.
class CollisionGuard final : public PathGate {
 public:
  explicit CollisionGuard(bool in_thread);
  ~CollisionGuard() override;

  /// From now on it goes by this, or by nothing: then it must not be asked.
  void put_in(std::shared_ptr<ClearWay> way);
  [[nodiscard]] bool on() const noexcept { return on_; }
  /// What is in the spindle when what is asked from now on runs; null: nobody knows.
  void set_tool(std::shared_ptr<const Tool> tool) noexcept { tool_ = std::move(tool); }

  void ask(std::shared_ptr<const PathSegment> segment) override;
  [[nodiscard]] Answer answer() override;
  void forget() override;
  [[nodiscard]] std::size_t ahead() const noexcept override { return in_thread_ ? kAhead : 1; }

  /// Nobody looks at what was dropped any more, whose modules may go then. Waits for one piece of that at most.
  void wait_until_idle();

  /// What nothing gets past, since it was answered.
  [[nodiscard]] const std::optional<Obstacle>& obstacle() const noexcept { return obstacle_; }
  /// What is not checked, a sentence each, since it was asked last.
  [[nodiscard]] std::vector<std::string> take_remarks();

 private:
  static constexpr std::size_t kAhead = 64;  ///< segments

  struct Question;  ///< a segment that was asked for and not yet answered to its end

  void look() noexcept;
  /// One piece of it.
  void look_at(Question& question);
  void remark(const Tool* tool);
  void remark_on(const std::string& what);

  const bool in_thread_;
  bool on_ = false;
  bool anew_ = true;  ///< what is asked next begins anywhere
  std::shared_ptr<ClearWay> way_;
  std::shared_ptr<const Tool> tool_;
  std::optional<Obstacle> obstacle_;

  // Of whoever looks.
  std::shared_ptr<ClearWay> way_looked_at_;
  std::shared_ptr<const Tool> tool_looked_at_;

  std::mutex mutex_;
  std::condition_variable wake_, idle_;
  std::deque<std::shared_ptr<Question>> questions_;
  std::vector<std::string> remarks_, remarked_;
  bool ends_ = false, looks_ = false;
  std::thread thread_;
};

}  // namespace rmac::gateway
