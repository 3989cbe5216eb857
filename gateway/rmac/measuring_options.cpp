#include "gateway/rmac/measuring_options.hpp"

#include <CLI/CLI.hpp>

namespace rmac::cli {

void add_measuring_commands(CLI::App& app, MeasureRequest& request, QualifyRequest& probe, const bool& json,
                            Command& command) {
  auto* measured =
      app.add_subcommand("measure", "measure the points of a plan: where the part lies, how far it is off");
  measured->add_option("PLAN", request.plan, "the measuring plan, a JSON file")->required();
  measured->add_flag("--apply", request.apply, "set the part frame to where the part lies; without it nothing is set");
  measured->add_flag("--upright", request.upright,
                     "leave out the part's tilt against the tool's axis, which a machine of slides cannot follow");
  measured->callback([&] { command = [&](auto& to) { return measure(to, request, json); }; });

  auto* qualified = app.add_subcommand(
      "qualify", "touch a sphere that is known: the radius of the probe's tip, and how far it is off");
  qualified->add_option("--sphere", probe.sphere, "its centre, x y z, and its radius, in the part frame, mm")
      ->required()
      ->expected(4);
  qualified->add_option("--tip-radius", probe.tip_radius_mm, "about, mm; that of the tool in the spindle unless given")
      ->check(CLI::Range(0.0, 100.0));
  qualified->add_option("--clearance", probe.clearance_mm, "off the sphere where it begins to measure a point, mm")
      ->check(CLI::Range(0.1, 1000.0))
      ->capture_default_str();
  qualified->add_option("--speed", probe.speed_mm_s, "between points, and towards them, mm/s")
      ->check(CLI::Range(0.01, 1000.0))
      ->capture_default_str();
  qualified->add_flag("--apply", probe.apply, "correct the tool in the spindle; without it nothing is set");
  qualified->callback([&] { command = [&](auto& to) { return qualify(to, probe, json); }; });
}

}  // namespace rmac::cli
