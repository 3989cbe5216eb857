#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "gateway/verification/checks/check.hpp"

namespace rmac::verifier {

/// A call of a port without state.
struct PortCall {
  const char* function = "";
  std::vector<NamedNumbers> arguments;                   ///< for a person
  std::size_t answers = 0;                               ///< numbers that it answers at most
  std::function<void(std::span<double> answer)> make{};  ///< any thread; what it leaves open stays as it was
};

/// How many thousands of calls in a row are made: watched as a whole, where somebody watches.
using MakesCalls = std::function<void(const char* function, const std::function<void()>& calls)>;

struct StatelessCase {
  std::vector<PortCall> calls;
  MakesCalls makes_calls = [](const char*, const std::function<void()>& make) { make(); };
  bool from_two_threads = true;
  double most_cpu_s = 15;  ///< for the calls that are repeated
  std::uint64_t seed = 1;
  Misdeed misdeed{};
};

/// The same call has the same answer, to the last bit, whatever was called before it, and while another thread calls
/// too. How often each function was called: three and a half million times, or what its time allowed.
[[nodiscard]] tl::expected<std::int64_t, CounterExample> check_stateless(const StatelessCase& given);

}  // namespace rmac::verifier
