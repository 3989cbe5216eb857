#include "rows.hpp"
#include "unit/drivers/law_changes.hpp"

namespace rmac::bench {

using namespace mill_test;

namespace {

class LateMillRun : public MillRun {
 public:
  LateMillRun() { simulated_->set_answer_delay(2); }
};

}  // namespace

void circle_rows(Figures& figures) {
  const char* const note = "50 mm at 6 m/min, 1 kHz, torque mode, friction 19 N, at the shafts";
  const Ballbar pid = MillRun().measure_circle({});
  const Ballbar fuzzy = MillRun().measure_circle([](nlohmann::json& device) { choose_fuzzy(device, 120); });
  const Ballbar exact = MillRun().measure_circle([](nlohmann::json& device) { choose_feedforward(device); });
  const Ballbar wrong = MillRun().measure_circle([](nlohmann::json& device) { choose_feedforward(device, 0.9); });
  const Ballbar late = LateMillRun().measure_circle([](nlohmann::json& device) { choose_feedforward(device); });
  figures.inform("circle_contour_pid", 1e3 * pid.contour_error(), "um", note);
  figures.inform("circle_contour_fuzzy", 1e3 * fuzzy.contour_error(), "um", "PID's gains at its centre");
  figures.at_most("circle_contour_feedforward", 1e3 * exact.contour_error(), 5, "um", note);
  figures.at_most("circle_contour_feedforward_model_10_percent_low", 1e3 * wrong.contour_error(), 5, "um", note);
  figures.inform("circle_reversal_spike_pid", 1e3 * pid.reversal_spike(), "um", note);
  figures.at_most("circle_reversal_spike_feedforward", 1e3 * exact.reversal_spike(), 3, "um", note);
  figures.at_most("circle_reversal_spike_feedforward_model_10_percent_low", 1e3 * wrong.reversal_spike(), 3, "um",
                  note);
  const char* const late_note = "answers two cycles old, one more than of drives that measure at each SYNC";
  figures.at_most("circle_contour_feedforward_late_answers", 1e3 * late.contour_error(), 5, "um", late_note);
  figures.at_most("circle_reversal_spike_feedforward_late_answers", 1e3 * late.reversal_spike(), 3, "um", late_note);
  LawChanges all;
  double method_difference_nm = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const LawChanges changes = LawChangesOnMill().change_laws_on_circle(seed);
    all.count += changes.count;
    all.gain_count += changes.gain_count;
    all.method_count += changes.method_count;
    const LawChanges same_methods = LawChangesOnMill().change_laws_on_circle(seed, false);
    method_difference_nm = std::max(method_difference_nm, largest_difference_nm(changes, same_methods));
    all.largest_gain_step_nm = std::max(all.largest_gain_step_nm, changes.largest_gain_step_nm);
    all.largest_step_nm = std::max(all.largest_step_nm, changes.largest_step_nm);
    all.largest_soon_nm = std::max(all.largest_soon_nm, changes.largest_soon_nm);
    all.largest_ever_nm = std::max(all.largest_ever_nm, changes.largest_ever_nm);
    all.rated_nm = changes.rated_nm;
  }
  figures.at_most("torque_step_where_laws_change", 100 * all.largest_step_nm / all.rated_nm, 1, "% of rated",
                  std::to_string(all.count) + " changes on the circle");
  figures.at_most("torque_step_where_gains_change", 100 * all.largest_gain_step_nm / all.rated_nm, 1, "% of rated",
                  std::to_string(all.gain_count) + " changes on the circle, to 0.6 to 1.1 of what they are");
  figures.at_most(
      "torque_step_where_methods_change", 100 * method_difference_nm / all.rated_nm, 1, "% of rated",
      std::to_string(all.method_count) +
          " changes on the circle, between position and velocity control: largest difference of any cycle to "
          "the same run without them");
  figures.inform("torque_change_a_cycle_soon_after_changes", 100 * all.largest_soon_nm / all.rated_nm, "% of rated",
                 "largest, in the three cycles after one");
  figures.inform("torque_change_a_cycle_elsewhere", 100 * all.largest_ever_nm / all.rated_nm, "% of rated",
                 "largest, in all other cycles");
}

}  // namespace rmac::bench
