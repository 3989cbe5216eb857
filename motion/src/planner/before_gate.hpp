#pragma once

#include <cstddef>
#include <deque>
#include <memory>

#include "rmac/motion/ports/path_gate.hpp"

namespace rmac {

/// Segments that are certain, and are not laid before a gate lets them through. Without a gate there are none. Planner
/// thread.
class BeforeGate {
 public:
  void set(PathGate* gate) noexcept { gate_ = gate; }
  [[nodiscard]] bool closed() const noexcept { return gate_ != nullptr; }

  /// What is certain together, and is laid together unless the gate cuts it.
  void hand_over(PathSegments fresh);
  /// Fewer wait than the gate wants.
  [[nodiscard]] bool wants_more() const noexcept { return !blocked_ && asked_.size() < gate_->ahead(); }
  /// What has passed, appended.
  void take(PathSegments& out);
  void clear();

  /// Nothing more gets through.
  [[nodiscard]] bool blocked() const noexcept { return blocked_; }
  /// There was no answer when one was needed.
  [[nodiscard]] bool waits() const noexcept { return waits_; }
  void wait_no_more() noexcept { waits_ = false; }

  [[nodiscard]] bool empty() const noexcept { return asked_.empty(); }
  [[nodiscard]] std::size_t size() const noexcept { return asked_.size(); }
  /// One of them, and where it begins behind a path that ends at `end`; also what of it was let through counts.
  [[nodiscard]] const PathSegment& segment(std::size_t i, double end, double& start) const noexcept;
  /// Where all of it ends.
  [[nodiscard]] double end(double end) const noexcept;

 private:
  struct Asked {
    std::shared_ptr<const PathSegment> segment;
    double given = 0;  ///< up to here it was let through
    bool last = true;  ///< of what is certain together
    bool passed = false;
  };
  /// How many from the first on have passed, at most to the end of what is laid together; what is said of the next one.
  [[nodiscard]] std::size_t passed(PathGate::Answer& next);

  PathGate* gate_ = nullptr;
  std::deque<Asked> asked_;
  bool blocked_ = false, waits_ = false;
};

}  // namespace rmac
