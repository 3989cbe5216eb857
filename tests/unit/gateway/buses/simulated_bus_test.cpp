#include "gateway/buses/simulated_bus.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "unit/gateway/buses/number_range.hpp"

namespace rmac::gateway {
namespace {

using fieldbus::AxisPlantParameters;
using fieldbus::SpindlePlantParameters;
using test::expect_range, test::NumberRange;
using testing::HasSubstr;

sdk::ModuleChoice bus(std::map<std::string, std::vector<double>> numbers) {
  return {"SimulatedInterface", std::move(numbers), {}};
}

TEST(SimulatedBus, HasTheExampleMachinesAxesWithoutParameters) {
  const auto axes = simulated_axes(bus({}));
  ASSERT_TRUE(axes);
  ASSERT_EQ(axes->size(), 8U);
  EXPECT_TRUE(std::holds_alternative<SpindlePlantParameters>((*axes)[3]));
  EXPECT_GT(std::get<AxisPlantParameters>((*axes)[2]).gravity_nm, 0);
}

TEST(SimulatedBus, TakesWhatIsSaidOfEachAxis) {
  const auto axes = simulated_axes(bus({{"axes", {3}},
                                        {"spindle", {1}},
                                        {"spindle_max_rpm", {4000}},
                                        {"spindle_max_torque_nm", {10}},
                                        {"rated_torque_nm", {2, 0, 4}},
                                        {"inertia_kg_m2", {1e-3, 0, 2e-3}},
                                        {"friction_nm", {0.1, 0, 0}},
                                        {"gravity_nm", {0, 0, -0.5}},
                                        {"counts_per_revolution", {1000, 0, 2000}}}));
  ASSERT_TRUE(axes) << axes.error().message;
  ASSERT_EQ(axes->size(), 3U);
  const auto& first = std::get<AxisPlantParameters>((*axes)[0]);
  const auto& last = std::get<AxisPlantParameters>((*axes)[2]);
  EXPECT_EQ(first.rated_torque_nm, 2);
  EXPECT_EQ(first.peak_torque_nm, 6);
  EXPECT_DOUBLE_EQ(first.inertia_kg_m2(), 1e-3);
  EXPECT_DOUBLE_EQ(first.coulomb_nm, 0.1);
  EXPECT_DOUBLE_EQ(first.static_nm, 0.12);
  EXPECT_EQ(last.gravity_nm, -0.5);
  EXPECT_EQ(last.encoder.counts_per_revolution, 2000);
  const auto& spindle = std::get<SpindlePlantParameters>((*axes)[1]);
  EXPECT_EQ(spindle.max_speed_rpm, 4000);
  EXPECT_EQ(spindle.max_torque_nm, 10);
}

TEST(SimulatedBus, TakesHowAnAxisGivesWaySticksAndCogs) {
  const auto axes = simulated_axes(bus({{"axes", {2}},
                                        {"spindle", {-1}},
                                        {"seed", {7}},
                                        {"rated_torque_nm", {0.318, 0.318}},
                                        {"inertia_kg_m2", {2.2e-5, 2.2e-5}},
                                        {"friction_nm", {0.015, 0.015}},
                                        {"stiffness_nm_rad", {0, 15.8}},
                                        {"load_inertia_kg_m2", {0, 1.27e-5}},
                                        {"damping_ratio", {0, 0.01}},
                                        {"play_turns", {0, 0.001}},
                                        {"friction_at_load", {0, 0.8}},
                                        {"presliding_turns", {0.001, 0.002}},
                                        {"cogging", {0.02, 0}},
                                        {"cogging_periods", {12, 60}},
                                        {"torque_ripple", {0.03, 0}},
                                        {"torque_ripple_periods", {6, 30}},
                                        {"encoder_noise_counts", {2, 0}},
                                        {"encoder_interpolation_counts", {3, 0}},
                                        {"encoder_signal_periods", {512, 2048}},
                                        {"encoder_at_load", {0, 1}}}));
  ASSERT_TRUE(axes) << axes.error().message;
  const auto& rigid = std::get<AxisPlantParameters>((*axes)[0]);
  const auto& soft = std::get<AxisPlantParameters>((*axes)[1]);
  EXPECT_FALSE(rigid.gives_way());
  EXPECT_EQ(rigid.cogging, 0.02);
  EXPECT_EQ(rigid.cogging_periods, 12);
  EXPECT_EQ(rigid.torque_ripple, 0.03);
  EXPECT_EQ(rigid.torque_ripple_periods, 6);
  EXPECT_EQ(rigid.encoder.noise_counts, 2);
  EXPECT_EQ(rigid.encoder.interpolation_counts, 3);
  EXPECT_EQ(rigid.encoder.signal_periods, 512);
  EXPECT_FALSE(rigid.encoder.at_load);
  EXPECT_TRUE(soft.encoder.at_load);
  EXPECT_NE(rigid.encoder.seed, soft.encoder.seed);
  ASSERT_TRUE(soft.gives_way());
  const fieldbus::TwoMassParameters masses = soft.two_masses();
  EXPECT_DOUBLE_EQ(masses.motor_inertia_kg_m2 + masses.load_inertia_kg_m2, 2.2e-5);
  EXPECT_DOUBLE_EQ(masses.load_inertia_kg_m2, 1.27e-5);
  EXPECT_EQ(masses.stiffness_nm_rad, 15.8);
  EXPECT_DOUBLE_EQ(masses.play_rad, 2 * M_PI * 0.001);
  EXPECT_DOUBLE_EQ(masses.load_friction.coulomb_nm, 0.8 * 0.015);
  EXPECT_DOUBLE_EQ(masses.motor_friction.coulomb_nm, 0.2 * 0.015);
  EXPECT_DOUBLE_EQ(masses.load_friction.presliding_rad, 2 * M_PI * 0.002);
  EXPECT_NEAR(masses.damping_nm_s_rad / (2 * std::sqrt(15.8 * 9.3e-6 * 1.27e-5 / 2.2e-5)), 0.01, 1e-9);
}

TEST(SimulatedBus, GivesEachAxisNoiseOfItsOwnForEachSeed) {
  std::set<std::uint64_t> seeds;
  for (const double seed : {0.0, 1.0, 2147483647.0}) {
    const auto axes = simulated_axes(bus({{"axes", {8}}, {"spindle", {-1}}, {"seed", {seed}}}));
    ASSERT_TRUE(axes);
    for (const auto& axis : *axes) seeds.insert(std::get<AxisPlantParameters>(axis).encoder.seed);
  }
  EXPECT_EQ(seeds.size(), 24U);
}

TEST(SimulatedBus, NamesAllThatItTakesWhereItIsToldSomethingElse) {
  const auto axes = simulated_axes(bus({{"noise", {1}}}));
  ASSERT_FALSE(axes);
  for (const char* name : {"late_answers", "contact_along", "spindle_max_torque_nm", "contact_slope", "rated_torque_nm",
                           "stiffness_nm_rad", "encoder_at_load"})
    EXPECT_THAT(axes.error().message, HasSubstr(name));
}

TEST(SimulatedBus, AnswersLateWhereItIsSaid) {
  EXPECT_EQ(simulated_answer_delay(bus({})), 0);
  EXPECT_EQ(simulated_answer_delay(bus({{"late_answers", {8}}})), 8);
  const auto nine = simulated_answer_delay(bus({{"late_answers", {9}}}));
  ASSERT_FALSE(nine);
  EXPECT_THAT(nine.error().message, HasSubstr("\"late_answers\" must be one whole number from 0 to 8"));
}

TEST(SimulatedBus, CanDoWithoutASpindle) {
  const auto axes = simulated_axes(bus({{"spindle", {-1}}}));
  ASSERT_TRUE(axes);
  for (const auto& axis : *axes) EXPECT_TRUE(std::holds_alternative<AxisPlantParameters>(axis));
}

TEST(SimulatedBus, RefusesWhatItCannotBe) {
  const std::vector<std::pair<std::map<std::string, std::vector<double>>, const char*>> cases{
      {{{"axes", {0}}}, "\"axes\" must be one whole number"},
      {{{"axes", {2.5}}}, "\"axes\" must be one whole number"},
      {{{"axes", {2}}, {"spindle", {2}}}, "the spindle is axis 2, and there are 2"},
      {{{"spindle_max_rpm", {0}}}, "\"spindle_max_rpm\" must be one number from 1 to 1000000"},
      {{{"inertia_kg_m2", {1e-3}}}, "has 1 numbers; give one for each of the 8 axes"},
      {{{"axes", {1}}, {"inertia_kg_m2", {0}}}, "\"inertia_kg_m2\": 0 of axis 0 must be 1e-08 to 1000"},
      {{{"axes", {1}}, {"spindle", {-1}}, {"stiffness_nm_rad", {15}}},
       "\"load_inertia_kg_m2\": 0 of axis 0 must be above 0"},
      {{{"axes", {1}}, {"spindle", {-1}}, {"stiffness_nm_rad", {15}}, {"load_inertia_kg_m2", {1}}},
       "and below the axis's"},
      {{{"axes", {1}}, {"spindle", {-1}}, {"stiffness_nm_rad", {1e5}}, {"load_inertia_kg_m2", {1e-5}}}, "at most 3000"},
      {{{"axes", {1}}, {"spindle", {-1}}, {"play_turns", {0.01}}}, "\"play_turns\" of axis 0 needs"},
      {{{"axes", {1}}, {"spindle", {-1}}, {"encoder_at_load", {1}}}, "\"encoder_at_load\" of axis 0 needs"},
      {{{"seed", {-1}}}, "\"seed\" must be one whole number"},
      {{{"axis", {1}}}, "\"axis\" is not understood; there are axes, spindle"},
  };
  for (const auto& [numbers, message] : cases) {
    const auto axes = simulated_axes(bus(numbers));
    ASSERT_FALSE(axes) << message;
    EXPECT_THAT(axes.error().message, HasSubstr(message));
  }
}

TEST(SimulatedBus, TakesWhatIsSaidOfAnAxisUpToItsBounds) {
  for (const NumberRange& range :
       {NumberRange{"rated_torque_nm", 1e-3, 1e4}, NumberRange{"inertia_kg_m2", 1e-8, 1e3},
        NumberRange{"friction_nm", 0, 1e4}, NumberRange{"gravity_nm", -1e4, 1e4},
        NumberRange{"negative_switch_turns", -1e6, 1e6}, NumberRange{"positive_switch_turns", -1e6, 1e6},
        NumberRange{"mode", 8, 10}, NumberRange{"counts_per_revolution", 1, 4294967296.0},
        NumberRange{"damping_ratio", 0, 1}, NumberRange{"friction_at_load", 0, 1},
        NumberRange{"presliding_turns", 1e-5, 1}, NumberRange{"cogging", 0, 1}, NumberRange{"cogging_periods", 1, 1e4},
        NumberRange{"torque_ripple", 0, 1}, NumberRange{"torque_ripple_periods", 1, 1e4},
        NumberRange{"encoder_noise_counts", 0, 1e6}, NumberRange{"encoder_interpolation_counts", 0, 1e6},
        NumberRange{"encoder_signal_periods", 1, 1e6}}) {
    expect_range(range, [&](double value) {
      return simulated_axes(bus({{"axes", {1}}, {"spindle", {-1}}, {range.name, {value}}})).has_value();
    });
  }
}

TEST(SimulatedBus, TakesOtherNumbersUpToTheirBounds) {
  expect_range({"spindle_max_rpm", 1, 1e6}, [](double value) {
    return simulated_axes(bus({{"spindle_max_rpm", {value}}})).has_value();
  });
  expect_range({"spindle_max_torque_nm", 1e-3, 1e5}, [](double value) {
    return simulated_axes(bus({{"spindle_max_torque_nm", {value}}})).has_value();
  });
  expect_range({"seed", 0, 2147483647}, [](double value) {
    return simulated_axes(bus({{"seed", {value}}})).has_value();
  });
  expect_range({"axes", 1, 64}, [](double value) {
    return simulated_axes(bus({{"axes", {value}}, {"spindle", {-1}}})).has_value();
  });
  expect_range({"spindle", -1, 63}, [](double value) {
    return simulated_axes(bus({{"axes", {64}}, {"spindle", {value}}})).has_value();
  });
}

TEST(SimulatedBus, TakesWhatIsSaidOfAPartUpToItsBounds) {
  for (const NumberRange& range :
       {NumberRange{"contact_surface_mm", -1e6, 1e6}, NumberRange{"contact_stiffness_n_mm", 1e-3, 1e6},
        NumberRange{"contact_damping_n_s_mm", 0, 1e4}, NumberRange{"contact_slope", -1, 1},
        NumberRange{"contact_wave_mm", 0, 100}, NumberRange{"contact_wave_length_mm", 0.1, 1e5},
        NumberRange{"contact_pitch_mm", 0.1, 1000}}) {
    expect_range(range, [&](double value) { return simulated_contact(bus({{range.name, {value}}})).has_value(); });
  }
}

TEST(SimulatedBus, CanHaveItsSpindleAtAnyPlace) {
  for (const std::size_t place : {0U, 3U, 7U}) {
    const auto axes = simulated_axes(bus({{"spindle", {static_cast<double>(place)}}}));
    ASSERT_TRUE(axes) << axes.error().message;
    for (std::size_t i = 0; i < axes->size(); ++i) {
      EXPECT_EQ(std::holds_alternative<SpindlePlantParameters>((*axes)[i]), i == place) << i;
    }
  }
}

TEST(SimulatedBus, HasAPartUnderTheToolWhenOneIsDescribed) {
  EXPECT_EQ(*simulated_contact(bus({})), std::nullopt);
  const auto contact = simulated_contact(bus({{"contact_surface_mm", {-12}}, {"contact_along", {1}}}));
  ASSERT_TRUE(contact && *contact);
  EXPECT_EQ((*contact)->surface_mm, -12);
  EXPECT_EQ((*contact)->axis, 2U);
  EXPECT_EQ((*contact)->along, 1U);
  EXPECT_EQ((*contact)->stiffness_n_mm, 1000) << "unless said";
}

TEST(SimulatedBus, RefusesAPartThatCannotBe) {
  const std::vector<std::pair<std::map<std::string, std::vector<double>>, const char*>> cases{
      {{{"contact_surface", {1}}}, "\"contact_surface\" is not understood"},
      {{{"contact_stiffness_n_mm", {0}}}, "\"contact_stiffness_n_mm\" must be one number from 0.001 to 1000000"},
      {{{"contact_slope", {0, 0}}}, "\"contact_slope\" must be one number from -1 to 1"},
      {{{"contact_axis", {8}}}, "\"contact_axis\" must be one whole number from 0 to 7"},
      {{{"contact_axis", {3}}}, "axis 3 is no servo axis"},
      {{{"contact_axis", {0}}}, "must be two axes"},
  };
  for (const auto& [numbers, message] : cases) {
    const auto contact = simulated_contact(bus(numbers));
    ASSERT_FALSE(contact) << message;
    EXPECT_THAT(contact.error().message, HasSubstr(message));
  }
}

}  // namespace
}  // namespace rmac::gateway
