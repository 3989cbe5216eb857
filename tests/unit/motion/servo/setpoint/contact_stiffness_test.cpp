#include "servo/setpoint/contact_stiffness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "unit/motion/servo/period.hpp"

namespace rmac::servo_test {
namespace {

TEST(ContactStiffness, IsFoundAsAJointComesUponASurface) {
  std::mt19937 random(3);
  for (int i = 0; i < 200; ++i) {
    const double stiffness = std::exp(std::uniform_real_distribution(std::log(100.0), std::log(50'000.0))(random));
    const double speed = std::uniform_real_distribution(2.0, 20.0)(random);
    ContactStiffness contact(kPeriod);
    std::normal_distribution<double> force(0, 0.02), position(0, 3e-5);
    double at = 0;
    for (int k = 0; k < 60; ++k) {
      contact.step(at + position(random), stiffness * at + force(random));
      at += speed * kPeriod * std::exp(-k * kPeriod / 0.01);
    }
    ASSERT_TRUE(contact.value()) << stiffness << " N/mm at " << speed << " mm/s";
    EXPECT_NEAR(*contact.value() / stiffness, 1, 0.05) << stiffness << " N/mm at " << speed << " mm/s";
  }
}

TEST(ContactStiffness, IsNotSaidWhereTheJointHardlyMoved) {
  std::mt19937 random(4);
  std::normal_distribution<double> noise(0, 3e-4);
  ContactStiffness contact(kPeriod);
  for (int i = 0; i < 5000; ++i) contact.step(noise(random), -20 + 100 * noise(random));
  EXPECT_FALSE(contact.value());
}

// A surface that waves under a joint which keeps its force moves the joint, and hardly the force: that is no softness.
TEST(ContactStiffness, IsNotMistakenWhereTheSurfaceMoves) {
  ContactStiffness contact(kPeriod);
  double at = 0;
  const auto step = [&](double surface) { contact.step(at, 5000 * (at - surface)); };
  for (int i = 0; i < 60; ++i) {
    step(0);
    at -= 0.005 * std::exp(-i * kPeriod / 0.01);
  }
  const double pressed = at;
  for (int i = 0; i < 5000; ++i) {
    const double wave = 0.05 * std::sin(2 * std::numbers::pi * i * kPeriod * 3);
    at = pressed + 0.97 * wave;
    step(wave);
  }
  EXPECT_NEAR(*contact.value(), 5000, 100);
}

TEST(ContactStiffness, IsFoundAgainWhereItGrows) {
  ContactStiffness contact(kPeriod);
  double stiffness = 500, at = 0;
  for (int i = 0; i < 2000; ++i) {
    if (i == 1000) stiffness = 5000;
    at = -0.05 - 0.03 * std::sin(2 * std::numbers::pi * i * kPeriod * 10);
    contact.step(at, stiffness * at);
  }
  EXPECT_NEAR(*contact.value(), 5000, 100);
  contact.forget();
  EXPECT_FALSE(contact.value());
}

}  // namespace
}  // namespace rmac::servo_test
