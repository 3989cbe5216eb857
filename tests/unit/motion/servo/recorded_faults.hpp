#pragma once

#include <gmock/gmock.h>

#include <vector>

#include "servo/faults/fault_sink.hpp"

namespace rmac::servo_test {

/// Keeps what is raised, in order.
class RecordedFaults final : public FaultSink {
 public:
  void raise(const ServoFault& found) noexcept override { raised.push_back(found); }
  std::vector<ServoFault> raised;
};

/// A fault of this kind and part, with all that it tells.
inline auto is_fault(ServoFault::Kind kind, ServoFault::Part part, std::uint32_t index, double value, double bound) {
  using testing::AllOf, testing::Field, testing::DoubleNear;
  return AllOf(Field("kind", &ServoFault::kind, kind), Field("part", &ServoFault::part, part),
               Field("index", &ServoFault::index, index), Field("value", &ServoFault::value, DoubleNear(value, 1e-9)),
               Field("bound", &ServoFault::bound, DoubleNear(bound, 1e-9)));
}

}  // namespace rmac::servo_test
