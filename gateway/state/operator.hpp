#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <utility>

#include "rmac/motion/error.hpp"

namespace rmac::gateway {

/// Who stands at the machine, beside the client that feeds its queue; one at a time (docs/decisions/0010-operator.md).
/// What they hold outlasts them, so others keep it by `OperatorRef`. Any thread.
class Operator {
 public:
  explicit Operator(std::string name) : name_(std::move(name)) {}

  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  /// False once their connection has ended, or they gave the place up.
  [[nodiscard]] bool present() const noexcept { return present_.load(std::memory_order_acquire); }
  void leave() noexcept { present_.store(false, std::memory_order_release); }

 private:
  const std::string name_;
  std::atomic<bool> present_{true};
};

/// Null stands for the program's client, or for nobody.
using OperatorRef = std::shared_ptr<const Operator>;

/// What the operator does to the cycle. Gateway thread.
class OperatorPort {
 public:
  virtual ~OperatorPort() = default;
  /// Holds what runs, and keeps anything else from starting; only an operator resumes.
  virtual Expected<> hold(const OperatorRef& who) = 0;
  virtual Expected<> resume(const OperatorRef& who) = 0;
  virtual Expected<double> retrace(double distance_mm, const OperatorRef& who) = 0;
  /// An override of 0 is a hold: only an operator raises it again.
  virtual Expected<> set_feed_override(double percent, const OperatorRef& who) = 0;
  /// Hands what an operator held to the holder of authority; nothing moves by it.
  virtual void let_go() = 0;
};

}  // namespace rmac::gateway
