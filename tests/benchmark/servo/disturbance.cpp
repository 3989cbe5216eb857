#include <cmath>
#include <string>

#include "rows.hpp"
#include "unit/drivers/honest_axes.hpp"
#include "unit/drivers/mill_on_simulated_bus.hpp"

namespace rmac::bench {

using namespace mill_test;

namespace {

/// DMACXYZ as it comes; its table is pushed along X while it stands.
class PushedMill : public MillRun {
 public:
  PushedMill() {
    simulated_ = std::make_shared<fieldbus::SimulatedInterface>(honest_axes(274, 0.03, 3), 0.001);
    bus_ = std::make_shared<ServoBus>(simulated_);
  }
  /// How far the table goes at most, in mm, and its encoder shows.
  struct Deviation {
    double table = 0, motor = 0;
  };
  Deviation push(double force_n) {
    Mill mill(
        "mill/3-axis/DMACXYZ", bus_, [](nlohmann::json& device) { device = declared("mill/3-axis/DMACXYZ"); },
        [](Mill& made, ServoLoopParts& parts) { make_good(made.device(), parts); });
    power_up(mill);
    move(mill, 5.3);
    dwell(mill, 2000);
    const fieldbus::AxisPlant& plant = simulated_->plant(0);
    const double table = plant.load_rad(), motor = plant.angle_rad();
    simulated_->push(0, force_n / 1000 / kRadPerMm);
    Deviation most;
    for (int i = 0; i < 1000; ++i) {
      cycle(mill);
      most.table = std::max(most.table, std::abs(plant.load_rad() - table) / kRadPerMm);
      most.motor = std::max(most.motor, std::abs(plant.angle_rad() - motor) / kRadPerMm);
    }
    return most;
  }
};

}  // namespace

void disturbance_rows(Figures& figures) {
  const char* const note = "the table at rest, axes that bend, stick and cog, gains as they come";
  for (const auto& [way, force_n] : {std::pair{"on", 50.0}, {"back", -50.0}}) {
    const PushedMill::Deviation most = PushedMill().push(force_n);
    const std::string name = std::string("step_of_50_n_") + way;
    figures.at_most(name, 1e3 * most.motor, 12, "um", std::string(note) + ", by the encoder");
    figures.inform(name + "_at_the_tool", 1e3 * most.table, "um", note);
  }
}

}  // namespace rmac::bench
