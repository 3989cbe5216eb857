#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "gateway/api/dispatch/dispatcher.hpp"
#include "gateway/controller/controller.hpp"

namespace rmac::gateway {

/// The appliance without threads, drives, sockets and clocks: the same API, device drivers, planner and cycle states
/// for one client, who holds motion authority, and machine time that goes on only when it is told to. One thread.
class Simulation {
 public:
  struct Options {
    std::filesystem::path device_tree;     ///< holds <type>/<configuration>/<Mechanism>/device.json
    std::filesystem::path searcher{};      ///< the program rmac-search; without it there are no searches
    std::filesystem::path tools_folder{};  ///< tool tables, only read; empty: none
    double period_s = 0.001;
    std::size_t queue_capacity = 10'000;  ///< moves
  };

  /// Loads `machine`: a mechanism's name in the device tree, or the path of a device.json; empty: none yet. The modules
  /// that a device.json names are looked for beside it, then in the tree's folder of the mechanism or the driver that
  /// it names, then among the shared ones.
  [[nodiscard]] static Expected<std::unique_ptr<Simulation>> open(const Options& options, const std::string& machine);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// What a client's request does, and its answer.
  [[nodiscard]] Answer call(const std::string& method, nlohmann::json params);
  /// Everything that can be planned now is planned, then one cycle passes. Listeners hear of it before this returns.
  void cycle();
  /// For listening, and for the state of things.
  [[nodiscard]] Controller& controller() noexcept;
  [[nodiscard]] std::size_t queue_capacity() const noexcept { return options_.queue_capacity; }
  [[nodiscard]] double period_s() const noexcept { return options_.period_s; }

 private:
  explicit Simulation(const Options& options);
  struct Parts;
  Options options_;
  std::unique_ptr<Parts> parts_;
};

}  // namespace rmac::gateway
