#include "gateway/verifier/watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <iterator>

namespace rmac::verifier {
namespace {

/// At most as much as there is room for, with a zero at its end.
template <std::size_t kSize>
void copy_text(const char* text, char (&into)[kSize]) noexcept {
  const std::size_t length = std::min(std::strlen(text), kSize - 1);
  std::memcpy(into, text, length);
  into[length] = '\0';
}

/// The line of a stack that lies in a module: modules are opened from private copies in folders of this name.
std::string line_of_module(const std::string& stack) {
  const std::size_t at = stack.find("/rmac-module-");
  if (at == std::string::npos) return "";
  const std::size_t begin = stack.find('/', at + 1) + 1;
  return stack.substr(begin, stack.find('\n', at) - begin);
}

}  // namespace

void Watch::step(const char* doing) noexcept {
  copy_text(doing, place_.doing);
  place_.in_call.store(false, std::memory_order_relaxed);
  place_.steps.fetch_add(1, std::memory_order_release);
}

void Watch::note(const char* call, std::initializer_list<Argument> arguments) noexcept {
  copy_text(call, place_.call);
  place_.values_count = 0;
  for (const Argument& argument : arguments) {
    if (place_.values_count == std::size(place_.values)) break;
    Place::Numbers& numbers = place_.values[place_.values_count++];
    copy_text(argument.name, numbers.name);
    numbers.count = static_cast<std::uint32_t>(std::min(argument.numbers.size(), std::size(numbers.numbers)));
    std::copy_n(argument.numbers.begin(), numbers.count, numbers.numbers);
  }
  place_.steps.fetch_add(1, std::memory_order_release);
}

void Watch::keep(const char* check, std::string what) noexcept {
  if (!what.empty()) misdeed_ = example_at(place_, check, std::move(what));
}

void Watch::keep_trapped() noexcept {
  const TrapCounts counts = take_trap_counts();
  std::string what = "on the cycle it ";
  const char* join = "";
  const auto add = [&](std::uint64_t count, const char* text) {
    if (count == 0) return;
    what += fmt::format("{}{} ({} times)", join, text, count);
    join = " and ";
  };
  add(counts.allocations, "allocates or frees memory");
  add(counts.locks, "locks");
  add(counts.system_calls, "calls the system");
  if (const std::string line = line_of_module(counts.first); !line.empty()) what += ", first from " + line;
  keep("real time", std::move(what));
}

Checked Watch::misdeed() const {
  return misdeed_ ? Checked(tl::unexpected<CounterExample>(*misdeed_)) : Checked();
}

CounterExample example_at(const Place& place, std::string check, std::string what) {
  const bool in_call = place.in_call.load(std::memory_order_relaxed);
  CounterExample example{std::move(check), fmt::format("{} in {}", what, in_call ? place.call : place.doing), -1, {}};
  if (!in_call) return example;
  for (std::uint32_t i = 0; i < std::min<std::size_t>(place.values_count, std::size(place.values)); ++i) {
    const Place::Numbers& value = place.values[i];
    example.values.push_back(named(
        value.name, std::span(value.numbers).first(std::min<std::size_t>(value.count, std::size(value.numbers)))));
  }
  return example;
}

}  // namespace rmac::verifier
