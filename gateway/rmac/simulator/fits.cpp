#include "gateway/rmac/simulator/fits.hpp"

#include <spdlog/spdlog.h>

#include "gateway/configuration/configuration.hpp"
#include "gateway/rmac/simulator/simulator.hpp"

namespace rmac::cli {

Fit fit_of(const Program& program, const std::string& machine, const std::filesystem::path& device_tree,
           const std::filesystem::path& tools) {
  spdlog::set_level(spdlog::level::off);  // what is wrong with other machines of the tree is not asked here
  const auto tree = device_tree.empty() ? gateway::default_folders().device_tree : device_tree;
  auto simulation = gateway::Simulation::open(
      {.device_tree = tree, .searcher = gateway::default_folders().searcher, .tools_folder = tools}, machine);
  if (!simulation) return {false, 0, simulation.error().message};
  Program on_it = program;
  std::erase_if(on_it.requests, loads_mechanism);
  const auto report = Simulator(**simulation, on_it, "").run();
  if (!report) return {false, 0, report.error().message};
  return {true, report->cycle_time_s, ""};
}

}  // namespace rmac::cli
