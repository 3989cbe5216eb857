#include "gateway/rmac/simulator/fits.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "gateway/bodies/link.hpp"
#include "gateway/configuration/configuration.hpp"
#include "gateway/rmac/simulator/collision_watch.hpp"
#include "gateway/rmac/simulator/shaped_machine.hpp"
#include "gateway/rmac/simulator/simulator.hpp"
#include "gateway/rmac/simulator/watch_verdict.hpp"
#include "rmac/motion/frame.hpp"

namespace rmac::cli {
namespace {

Fit misfit(std::string why) {
  return {.why_not = std::move(why)};
}

std::optional<double> spindle_used(const CollisionWatch& watch) {
  if (watch.load() == nullptr || watch.load()->most_used() == 0) return std::nullopt;
  return watch.load()->most_used();
}

/// From the middle of a body to its sides, along the axes of the machine frame; none of a mesh.
std::optional<Vector> half_sides(const gateway::Body& body) {
  const auto axis = [&](Vector unit) { return rotate(body.pose.q, unit); };
  const std::array axes{axis({1, 0, 0}), axis({0, 1, 0}), axis({0, 0, 1})};
  Vector half{};
  for (std::size_t i = 0; i < 3; ++i) {
    if (const auto* box = std::get_if<gateway::BoxShape>(&body.shape)) {
      for (std::size_t j = 0; j < 3; ++j) half[i] += std::abs(axes[j][i]) * box->size[j] / 2;
    } else if (const auto* cone = std::get_if<gateway::ConeShape>(&body.shape)) {
      const double along = std::abs(axes[2][i]), radius = std::max(cone->bottom_radius, cone->top_radius);
      half[i] = along * cone->height / 2 + std::sqrt(std::max(0.0, 1 - along * along)) * radius;
    } else if (const auto* sphere = std::get_if<gateway::SphereShape>(&body.shape)) {
      half[i] = sphere->radius;
    } else {
      return std::nullopt;
    }
  }
  return half;
}

/// The middle of the top of what carries the part, while all joints stand at 0.
std::optional<Vector> table_top(const gateway::MachineBodies& machine) {
  std::optional<Vector> low, high;
  for (const gateway::Body& body : machine.bodies) {
    if (body.link != gateway::kTable) continue;
    const auto half = half_sides(body);
    if (!half) return std::nullopt;
    if (!low) low = high = body.pose.p;
    for (std::size_t i = 0; i < 3; ++i) {
      (*low)[i] = std::min((*low)[i], body.pose.p[i] - (*half)[i]);
      (*high)[i] = std::max((*high)[i], body.pose.p[i] + (*half)[i]);
    }
  }
  if (!low) return std::nullopt;
  return Vector{((*low)[0] + (*high)[0]) / 2, ((*low)[1] + (*high)[1]) / 2, (*high)[2]};
}

/// The set-up as it stands on a machine, which may be another than its own.
Result<gateway::Setup> setup_on(const FitQuestion& question, const std::filesystem::path& tree,
                                const std::string& machine) {
  auto setup = gateway::read_setup(question.setup_file);
  if (!setup) return fail(setup.error().message);
  if (setup->machine == machine) return std::move(*setup);
  const auto own = read_shaped_machine(setup->machine, tree, "nobody knows where the part stands on other machines");
  if (!own) return fail(fmt::format("{}: /Machine: {}", question.setup_file.string(), own.error().message));
  const auto other = read_shaped_machine(machine, tree, "collisions cannot be checked");
  if (!other) return tl::unexpected(other.error());
  setup->part_frame = part_frame_on(own->bodies, other->bodies, setup->part_frame);
  setup->machine = machine;
  return std::move(*setup);
}

}  // namespace

Frame part_frame_on(const gateway::MachineBodies& own, const gateway::MachineBodies& other, const Frame& part_frame) {
  const auto from = table_top(own), to = table_top(other);
  Frame moved = part_frame;
  for (std::size_t i = 0; from && to && i < 3; ++i) moved.p[i] += (*to)[i] - (*from)[i];
  return moved;
}

Fit fit_of(const FitQuestion& question, const std::string& machine) {
  spdlog::set_level(spdlog::level::off);  // what is wrong with other machines of the tree is not asked here
  const auto defaults = gateway::default_folders();
  const auto tree = question.device_tree.empty() ? defaults.device_tree : question.device_tree;
  auto simulation = gateway::Simulation::open(
      {.device_tree = tree, .searcher = defaults.searcher, .tools_folder = question.tools}, machine);
  if (!simulation) return misfit(simulation.error().message);
  std::unique_ptr<CollisionWatch> watch;
  if (!question.setup_file.empty()) {
    auto setup = setup_on(question, tree, machine);
    if (!setup) return misfit(setup.error().message);
    auto watched =
        CollisionWatch::open(machine, tree, std::move(*setup),
                             {.setup_file = question.setup_file,
                              .materials = question.materials.empty() ? defaults.materials : question.materials});
    if (!watched) return misfit(watched.error().message);
    watch = std::move(*watched);
    if (auto placed = watch->place_part(**simulation); !placed) return misfit(placed.error().message);
  }
  Program on_it = question.program;
  std::erase_if(on_it.requests, loads_mechanism);
  Simulator simulator(**simulation, on_it, "");
  if (watch) simulator.watch_collisions(*watch, false);
  const auto report = simulator.run();
  if (!report) return misfit(report.error().message);
  if (!watch) return {.fits = true, .cycle_time_s = report->cycle_time_s};
  if (auto fine = verdict(*watch); !fine) return misfit(fine.error().message);
  return {.fits = true, .cycle_time_s = report->cycle_time_s, .spindle_used = spindle_used(*watch)};
}

}  // namespace rmac::cli
