// `rmac tune --creep` finds friction by the model that the laws with feedforward work it out with:
// gateway/rmac/plots/creep.py has it again.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iomanip>
#include <iterator>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "places.hpp"
#include "rmac/modules/feedforward_model.hpp"

namespace {

using namespace rmac;
using modules::FeedforwardModel;

constexpr double kPeriod_s = 0.001;

/// mm/s: to and fro at all speeds, with rests, crossings of zero and jumps, each some presliding ways long.
std::vector<double> seeded_velocities(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> exponent(-3, 2), share(-1, 1);
  std::uniform_int_distribution<int> length(1, 60);
  std::vector<double> velocities;
  while (velocities.size() < 2000) {
    const double from = share(random) * std::pow(10, exponent(random)), to = length(random) < 10 ? 0 : share(random);
    const int cycles = length(random);
    for (int i = 0; i < cycles; ++i) velocities.push_back(from + (to - from) * i / cycles);
  }
  return velocities;
}

std::vector<double> of_the_law(const FeedforwardModel::Parameters& parameters, const std::vector<double>& velocities) {
  FeedforwardModel model(parameters);
  model.set_gains(std::array{0.0, 0.0, 1.0, 0.0});
  std::vector<double> friction;
  for (const double velocity : velocities) {
    ServoInput input;
    input.velocity_setpoint = velocity;
    input.period_s = kPeriod_s;
    model.step(input);
    friction.push_back(model.effort(input));
  }
  return friction;
}

std::vector<double> of_the_program(const FeedforwardModel::Parameters& parameters,
                                   const std::vector<double>& velocities) {
  const std::string file = testing::TempDir() + "rmac_velocities_" + std::to_string(::getpid());
  std::ofstream out(file);
  out << std::setprecision(17);
  for (const double velocity : velocities) out << velocity << '\n';
  out.close();
  std::ostringstream command;
  command << std::setprecision(17)
          << "cd " RMAC_SOURCE_DIR
             "/gateway/rmac/plots && /usr/bin/python3 -B -c 'import creep, numpy; v = numpy.loadtxt(\""
          << file << "\"); print(*map(repr, creep.bent(v * " << kPeriod_s << " / " << parameters.presliding << ", v, "
          << parameters.breakaway << ", " << parameters.stribeck_speed << ").tolist()))'";
  std::string said;
  if (std::FILE* const program = ::popen(command.str().c_str(), "r"); program != nullptr) {
    std::array<char, 4096> part{};
    while (std::fgets(part.data(), static_cast<int>(part.size()), program) != nullptr) said += part.data();
    EXPECT_EQ(::pclose(program), 0) << command.str();
  }
  std::remove(file.c_str());
  std::istringstream numbers(said);
  return {std::istream_iterator<double>(numbers), {}};
}

TEST(FeedforwardFriction, IsWhatCreepingIsFittedTo) {
  constexpr std::array<FeedforwardModel::Parameters, 3> kCases{
      {{.presliding = 0.01, .breakaway = 1.2, .stribeck_speed = 1},
       {.presliding = 0.0007, .breakaway = 1, .stribeck_speed = 0.05},
       {.presliding = 0.2, .breakaway = 2.7, .stribeck_speed = 20}}};
  for (unsigned seed = 0; seed < kCases.size(); ++seed) {
    const std::vector<double> velocities = seeded_velocities(seed);
    const std::vector<double> law = of_the_law(kCases[seed], velocities);
    const std::vector<double> program = of_the_program(kCases[seed], velocities);
    ASSERT_EQ(program.size(), law.size());
    for (std::size_t i = 0; i < law.size(); ++i)
      ASSERT_NEAR(program[i], law[i], 1e-9) << "seed " << seed << ", cycle " << i << ", " << velocities[i] << " mm/s";
  }
}

}  // namespace
