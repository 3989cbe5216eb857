#pragma once

#include <functional>
#include <string>
#include <vector>

#include "gateway/modules/module_loader.hpp"
#include "gateway/threads/sanitized.hpp"
#include "gateway/verification/report.hpp"
#include "gateway/verifier/watch.hpp"
#include "rmac/sdk/device_object.hpp"

namespace rmac::verifier {

/// Joint vectors that a check takes, unless told; fewer where a sanitizer makes each take many times as long.
inline constexpr int kSamples = kSanitized ? 20'000 : 100'000;

/// What to check a mechanism's modules with.
struct Task {
  sdk::DeviceObject device;
  std::vector<std::string> chain;  ///< in which order its links carry each other; empty: nobody says
  gateway::ModuleLoader loader;
  int samples = kSamples;
  std::uint64_t seed = 1;
  double period_s = 0.001;  ///< cycle of the servo loop that it is to run in
};

/// Checks one module in one role, in a process of its own: the module may crash it, hang it, or fill its memory. What
/// it finds out goes into `report` bit by bit, and `tell` is called after each, so that what was found before a crash
/// is not lost.
struct Job {
  std::string role;
  std::string module;
  std::function<void(const Task& task, Watch& watch, ModuleReport& report, const std::function<void()>& tell)> run;
};

/// The jobs that a mechanism needs, the modules that others rest on first.
[[nodiscard]] std::vector<Job> jobs_for(const sdk::DeviceObject& device);

}  // namespace rmac::verifier
