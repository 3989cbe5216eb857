#include <cmath>
#include <string>

#include "rows.hpp"
#include "unit/drivers/honest_axes.hpp"
#include "unit/drivers/mill_on_simulated_bus.hpp"

namespace rmac::bench {

using namespace mill_test;

namespace {

/// What `rmac tune 0 --travel 40 --creep` finds of X with a period of 0.25 ms, rounded.
void tune_at_4_khz(nlohmann::json& device) {
  nlohmann::json& x = device["Joints"][0];
  x["Gains"] = {3490, 380000, 17.2};
  x["Resonances"] = nlohmann::json::array({{{"Frequency", 273.2}, {"Damping", 0.2}, {"Width", 0.5}}});
  x["LowPass"] = 0;
  x["ServoControlLaw"]["Parameters"]["lead_s"] = {0.00088};
  device["Actuators"][0]["Cogging"]["Lead"] = 0.00054;
}

/// DMACXYZ, its gains as they come or as they were tuned; its table is pushed along X while it stands.
class PushedMill : public MillRun {
 public:
  explicit PushedMill(double period_s, const Mill::Edit& tune) : tune_(tune) {
    period_s_ = period_s;
    simulated_ = std::make_shared<fieldbus::SimulatedInterface>(honest_axes(274, 0.03, 3), period_s);
    bus_ = std::make_shared<ServoBus>(simulated_);
  }
  /// How far the table goes at most, in mm, and its encoder shows.
  struct Deviation {
    double table = 0, motor = 0;
  };
  Deviation push(double force_n) {
    Mill mill(
        "mill/3-axis/DMACXYZ", bus_,
        [this](nlohmann::json& device) {
          device = declared("mill/3-axis/DMACXYZ");
          tune_(device);
        },
        [this](Mill& made, ServoLoopParts& parts) {
          make_good(made.device(), parts);
          parts.period_s = period_s_;
        });
    power_up(mill);
    move(mill, 5.3);
    dwell(mill, cycles(2));
    const fieldbus::AxisPlant& plant = simulated_->plant(0);
    const double table = plant.load_rad(), motor = plant.angle_rad();
    simulated_->push(0, force_n / 1000 / kRadPerMm);
    Deviation most;
    for (int i = 0; i < cycles(1); ++i) {
      cycle(mill);
      most.table = std::max(most.table, std::abs(plant.load_rad() - table) / kRadPerMm);
      most.motor = std::max(most.motor, std::abs(plant.angle_rad() - motor) / kRadPerMm);
    }
    return most;
  }

 private:
  [[nodiscard]] int cycles(double seconds) const { return static_cast<int>(std::lround(seconds / period_s_)); }

  Mill::Edit tune_;
};

}  // namespace

void disturbance_rows(Figures& figures) {
  struct Loop {
    const char* name;
    double period_s, most_um;
    Mill::Edit tune;
    const char* gains;
  };
  const auto as_it_comes = [](nlohmann::json&) {};
  for (const Loop& loop : {Loop{"", 0.001, 12, as_it_comes, "as they come"},
                           Loop{"_at_4_khz", 0.00025, 6, tune_at_4_khz, "of rmac tune at 4 kHz"}}) {
    const std::string note = std::string("the table at rest, axes that bend, stick and cog, gains ") + loop.gains;
    for (const auto& [way, force_n] : {std::pair{"on", 50.0}, {"back", -50.0}}) {
      const PushedMill::Deviation most = PushedMill(loop.period_s, loop.tune).push(force_n);
      const std::string name = std::string("step_of_50_n_") + way + loop.name;
      figures.at_most(name, 1e3 * most.motor, loop.most_um, "um", note + ", by the encoder");
      figures.inform(name + "_at_the_tool", 1e3 * most.table, "um", note);
    }
  }
}

}  // namespace rmac::bench
