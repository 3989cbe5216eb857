#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "gateway/verification/report.hpp"
#include "rmac/motion/error.hpp"
#include "rmac/sdk/device_object.hpp"

namespace rmac::gateway {

/// Has the verifier, a program of its own, check a mechanism's modules before they go live: a module that crashes does
/// so there. What passed is remembered until its files change. Blocks while the verifier runs. Any thread.
class Verification {
 public:
  struct Options {
    std::filesystem::path program;                      ///< rmac-verify
    std::filesystem::path verdicts;                     ///< folder for what passed; empty: nothing is remembered
    std::vector<std::filesystem::path> module_folders;  ///< searched after the mechanism's own
    std::chrono::seconds patience{600};                 ///< then the verifier is killed
    double period_s = 0.001;                            ///< cycle of the servo loop that it is to run in
  };

  explicit Verification(Options options) : options_(std::move(options)) {}

  /// What the verifier finds out now. An error when it cannot be run, or the device database makes no sense.
  [[nodiscard]] Expected<verifier::Report> verify(const std::filesystem::path& device_json) const;

  /// Nothing when this mechanism passed before and none of its files changed since, or passes now; otherwise the first
  /// counter-example.
  [[nodiscard]] Expected<> require(const std::filesystem::path& device_json) const;

  /// The same of a mechanism that no file describes; `folder` is where its modules are looked for first.
  [[nodiscard]] Expected<> require(const sdk::DeviceObject& device, const std::filesystem::path& folder) const;

  /// Ends a verification that runs, and has none begin any more: the process is about to end. Any thread.
  void cancel() noexcept { cancelled_ = true; }

 private:
  /// A mechanism's device database, and where its modules are looked for, in order.
  struct Subject {
    std::filesystem::path device_json;
    std::vector<std::filesystem::path> folders;
  };
  [[nodiscard]] Subject beside(const std::filesystem::path& device_json) const;
  [[nodiscard]] Expected<verifier::Report> verify(const Subject& subject) const;
  [[nodiscard]] Expected<> require(const Subject& subject) const;
  /// Changes with the device database, with every module it names, with the cycle's time, and with the verifier; empty
  /// when a file is missing.
  [[nodiscard]] std::string fingerprint(const Subject& subject, const sdk::DeviceObject& device) const;

  /// As the verifier is told it.
  [[nodiscard]] std::string period() const;

  Options options_;
  std::atomic<bool> cancelled_{false};
};

}  // namespace rmac::gateway
