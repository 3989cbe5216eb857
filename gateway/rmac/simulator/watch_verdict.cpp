#include "gateway/rmac/simulator/watch_verdict.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace rmac::cli {

Result<> collision_verdict(const CollisionWatch& watch) {
  std::vector<std::string> clauses;
  const auto found = watch.findings().sorted();
  const auto certain = [](const gateway::Finding& f) { return f.collision && !f.possible; };
  if (const auto first = std::ranges::find_if(found, certain); first != found.end()) {
    clauses.push_back(fmt::format("{} collisions, the first in line {}: {} meets {}",
                                  std::ranges::count_if(found, certain), first->line, first->second, first->first));
  }
  clauses.insert(clauses.end(), watch.not_checked().begin(), watch.not_checked().end());
  return clauses.empty() ? Result<>() : fail(fmt::format("{}", fmt::join(clauses, "; ")));
}

Result<> force_verdict(const CollisionWatch& watch) {
  std::vector<std::string> clauses;
  if (const gateway::CuttingLoad* const load = watch.load(); load != nullptr && !load->overloads().empty()) {
    const gateway::Overload& first = load->overloads().front();
    clauses.push_back(
        fmt::format("{} times cutting takes more than the spindle has, first in line {}: {:.3g} of {:.3g} {}",
                    load->overloads().size(), first.line, first.most, first.allowed, unit_of(first.of)));
  }
  const auto not_told = watch.forces_not_told();
  clauses.insert(clauses.end(), not_told.begin(), not_told.end());
  return clauses.empty() ? Result<>() : fail(fmt::format("{}", fmt::join(clauses, "; ")));
}

Result<> both(const Result<>& first, const Result<>& second) {
  if (!first && !second) return fail(first.error().message + "; " + second.error().message);
  return first ? second : first;
}

Result<> verdict(const CollisionWatch& watch) {
  return both(collision_verdict(watch), force_verdict(watch));
}

const char* name_of(gateway::Overload::Of of) noexcept {
  return of == gateway::Overload::Of::Torque ? "torque" : "power";
}

const char* unit_of(gateway::Overload::Of of) noexcept {
  return of == gateway::Overload::Of::Torque ? "N·m" : "W";
}

}  // namespace rmac::cli
