#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "drive.hpp"
#include "limit_check.hpp"
#include "machines.hpp"
#include "rows.hpp"
#include "shapes.hpp"

namespace rmac::bench {
namespace {

using Json = nlohmann::json;

ToolPose pose_of(const Json& frame) {
  return {frame.at("p").get<Vector>(), kUp};
}

/// The moves of the demo's sweep, in the part frame, with the feed in force; what is no motion is left out.
struct Sweep {
  Frames frames;
  std::vector<Move> moves;
};

Sweep read(const std::string& file) {
  Sweep sweep;
  std::ifstream lines(file);
  double feed_mm_s = 0;
  for (std::string line; std::getline(lines, line);) {
    const Json request = Json::parse(line);
    const std::string method = request.at("method");
    const Json& params = request.at("params");
    Move move;
    move.id = params.value("MoveID", std::int64_t{0});
    move.feed_mm_s = feed_mm_s;
    if (method == "RMAC_CAM.SetPartFrame") {
      sweep.frames.part = {params.at("PartFrame").at("p").get<Vector>(),
                           params.at("PartFrame").at("q").get<std::array<double, 4>>()};
    } else if (method == "RMAC_CAM.SetFeedrate") {
      feed_mm_s = params.at("Feedrate").get<double>() / 60;
    } else if (method == "RMAC_CAM.MoveToPathTarget") {
      move.geometry = PathTargetGeometry{pose_of(params.at("TargetFrame"))};
      sweep.moves.push_back(std::move(move));
    } else if (method == "RMAC_CAM.MoveAlongLine") {
      move.geometry = LineGeometry{pose_of(params.at("StartPoint")), pose_of(params.at("EndPoint"))};
      sweep.moves.push_back(std::move(move));
    } else if (method == "RMAC_CAM.MoveAlongNurbs") {
      const Json& wire = params.at("Nurbs");
      Nurbs nurbs{wire.at("degree"), 3, wire.at("knots"), wire.at("points"), {}};
      if (wire.contains("weights")) nurbs.weights = wire.at("weights").get<std::vector<double>>();
      move.geometry = NurbsGeometry{NurbsSpace::Tip, std::move(nurbs)};
      sweep.moves.push_back(std::move(move));
    }
  }
  return sweep;
}

}  // namespace

/// The demo's ball-end sweep on its own machine's limits: reading, building, planning and every cycle's setpoint.
void headlight_rows(Figures& figures, const Extent&) {
  const char* const file = std::getenv("RMAC_BENCH_HEADLIGHT");
  const std::string name = "headlight_simulation";
  if (file == nullptr) {
    figures.missing(name, ">= 200", "x real time",
                    "the demo's program was not made: start with tests/benchmark/motion/run");
    return;
  }
  const double began = cpu_time_s();
  const Sweep sweep = read(file);
  const PlannerModel model = bench_xyz();
  Drive drive(model, {0, 0, 0});
  drive.builder.restart(std::vector<double>(3, 0.0), sweep.frames);
  std::int64_t moving = 0;
  drive.on_setpoint = [&](const Setpoint& setpoint) { moving += setpoint.moving ? 1 : 0; };
  for (const Move& move : sweep.moves) {
    if (auto queued = drive.queue(move); !queued) {
      figures.missing(name, ">= 200", "x real time", queued.error().message);
      return;
    }
  }
  drive.planner.command(PathCommand::Run);
  if (!drive.run()) {
    figures.missing(name, ">= 200", "x real time", "did not come to its end");
    return;
  }
  const double took = cpu_time_s() - began, travel_s = static_cast<double>(moving) * model.period_s;
  figures.at_least(name, travel_s / took, 200, "x real time",
                   std::to_string(sweep.moves.size()) + " moves, CPU time, at the planner's own interface");
  figures.inform("headlight_cycle_time", travel_s, "s");
}

}  // namespace rmac::bench
