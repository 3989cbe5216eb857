#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <utility>

#include "rmac/motion/ports/kinematics.hpp"
#include "rmac/sdk/module.hpp"

/// A static of an inline function that is visible is one for the whole process, unless -fno-gnu-unique says otherwise.
[[gnu::visibility("default")]] inline int& kept_for_good() {
  static int value = 0;
  return value;
}

namespace {

using namespace rmac;

enum class Defect {
  None,
  CrashesInFactory,
  CrashesInForward,
  Hangs,
  Sleeps,
  Allocates,
  Leaks,
  LiesAboutInverse,
  LiesAboutJacobian,
  LiesAboutJoints,
  HasAnotherAbi,
  StaysMapped,
  EatsMemory,
  HangsWhenTold,
  IsSlow,
  IsSlowInASlab,
  OverrunsJacobian,
  Remembers,
  SharesScratch,
  Tires,
  Saturates
};
constexpr Defect kDefect = Defect::DEFECT;
/// Where on the first joint's travel the defect shows.
constexpr double kFrom_mm = 40;

/// A tool of this length and `n` mm more has the n-th thread hang that asks for the inverse under it: the gateway's
/// (0), which builds a move, the planner's (1), or the servo thread (2).
constexpr double kHangingTool_mm = 77.125;
/// Under this one the servo thread is told a place 5 mm off, some way into its path.
constexpr double kLyingTool_mm = kHangingTool_mm + 3;
constexpr int kTrueAnswers = 200;

/// The how manieth thread the calling one is of those that have called this.
int number_of_caller() {
  static std::array<std::atomic<pthread_t>, 8> callers{};
  const pthread_t self = pthread_self();
  for (std::size_t i = 0; i < callers.size(); ++i) {
    pthread_t nobody{};
    if (callers[i].compare_exchange_strong(nobody, self) || nobody == self) return static_cast<int>(i);
  }
  return -1;
}

void hang_if_told(const Frame& tool) {
  const double told = tool.p[2] - kHangingTool_mm;
  if (!(told >= 0 && told <= 2) || number_of_caller() != static_cast<int>(told)) return;
  std::fputs("BadKinematics hangs\n", stderr);  // who tests what comes of it wants to know when
  for (volatile bool more = true; more;) {
  }
}

bool lies_as_told(const Frame& tool) {
  static std::atomic<int> answers{0};
  return tool.p[2] == kLyingTool_mm && number_of_caller() == 2 && ++answers > kTrueAnswers;
}

/// A turn takes a nanosecond or two.
void compute(int turns) noexcept {
  volatile double sum = 0;
  for (int i = 0; i < turns; ++i) {
    const double before = sum;
    sum = before + 1;
  }
}

/// Between what a call may take on the average and at worst, however quick the computer is.
void dawdle() noexcept {
  using Clock = std::chrono::steady_clock;
  const auto until = Clock::now() + std::chrono::microseconds(60);
  while (Clock::now() < until) compute(100);
}

/// Not at zero, where a sanitizer would have its say.
[[gnu::noinline]] void crash() {
  volatile std::uintptr_t nothing_there = 64;
  *reinterpret_cast<volatile int*>(nothing_there) = 1;
}

/// Joints are x, y and z.
class BadKinematics final : public Kinematics {
 public:
  std::size_t joint_count() const noexcept override { return 3; }
  JointType joint_type(std::size_t joint) const noexcept override {
    return kDefect == Defect::LiesAboutJoints && joint == 2 ? JointType::Rotary : JointType::Linear;
  }
  void forward(std::span<const double> joints, const Frame& tool, ToolPose& pose) const noexcept override {
    if (joints[0] > kFrom_mm) {
      if (kDefect == Defect::CrashesInForward) crash();
      if (kDefect == Defect::Allocates) delete new volatile double(joints[0]);
      if (kDefect == Defect::Sleeps) {
        while (true) ::pause();
      }
      for (volatile bool more = kDefect == Defect::Hangs; more;) {
      }
    }
    const ToolPose at_zero = tool_at_zero(tool);
    for (std::size_t i = 0; i < 3; ++i) pose.tip[i] = joints[i] + at_zero.tip[i];
    pose.axis = at_zero.axis;
  }
  KinematicsStatus inverse(const ToolPose& pose, const Frame& tool, std::span<const double>,
                           std::span<double> joints) const noexcept override {
    if (kDefect == Defect::HangsWhenTold) hang_if_told(tool);
    if (kDefect == Defect::IsSlow) dawdle();
    constexpr double kSlab_mm = 0.1;
    if (kDefect == Defect::IsSlowInASlab && std::abs(pose.tip[0] - kFrom_mm) < kSlab_mm) {
      compute(1'000'000);
    }
    const ToolPose at_zero = tool_at_zero(tool);
    for (std::size_t i = 0; i < 3; ++i) joints[i] = pose.tip[i] - at_zero.tip[i];
    misbehave(joints);
    if (kDefect == Defect::HangsWhenTold && lies_as_told(tool)) joints[1] += 5;
    if (kDefect == Defect::LiesAboutInverse && joints[0] > kFrom_mm) joints[1] += 1e-6;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!(std::abs(pose.axis[i] - at_zero.axis[i]) < 1e-9) || !std::isfinite(joints[i])) {
        return KinematicsStatus::OutOfReach;
      }
    }
    return KinematicsStatus::Ok;
  }
  void jacobian(std::span<const double> joints, const Frame&, std::span<double> jacobian) const noexcept override {
    std::fill(jacobian.begin(), jacobian.end(), 0.0);
    for (std::size_t i = 0; i < 3; ++i) jacobian[i * 3 + i] = 1;
    if (kDefect == Defect::OverrunsJacobian) jacobian.data()[jacobian.size()] = 0;
    if (kDefect == Defect::LiesAboutJacobian && joints[0] > kFrom_mm) jacobian[1] = 1e-3;
  }

 private:
  /// Whatever keeps within what a single call is held to.
  static void misbehave(std::span<double> joints) noexcept {
    if (kDefect == Defect::Remembers) {
      static double last = 0;
      joints[1] += 1e-12 * std::exchange(last, joints[0]);
    }
    if (kDefect == Defect::SharesScratch) {
      static volatile double scratch = 0;
      scratch = joints[1];
      compute(500);
      joints[1] = scratch;
    }
    constexpr int kTiring = 3'000'000;
    static std::atomic<int> calls{0};
    if (kDefect == Defect::Tires && ++calls > kTiring) joints[1] += 5;
    constexpr double kReach_mm = 50.5;
    for (double& joint : joints) {
      if (kDefect == Defect::Saturates) joint = std::clamp(joint, -kReach_mm, kReach_mm);
    }
  }
  static ToolPose tool_at_zero(const Frame& tool) noexcept {
    const auto [w, x, y, z] = tool.q;
    return {tool.p, {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
  }
};

struct Factory {
  static Kinematics* create(sdk::Parameters, char*, std::size_t) {
    if (kDefect == Defect::CrashesInFactory) crash();
    // Stored, for what is not used may be left out.
    [[maybe_unused]] static void* volatile kept = nullptr;
    if (kDefect == Defect::Leaks) kept = new double[16];
    if (kDefect == Defect::StaysMapped) ++kept_for_good();
    if (kDefect == Defect::EatsMemory) kept = new char[std::size_t{4} << 30U];
    return new BadKinematics;
  }
};

}  // namespace

extern "C" __attribute__((visibility("default"))) const sdk::ModuleDescriptor* rmac_module() noexcept {
  static constexpr sdk::ModuleDescriptor kDescriptor{
      sdk::kModuleAbi + (kDefect == Defect::HasAnotherAbi ? 1 : 0),
      sdk::ModuleKind::Kinematics,
      "BadKinematics",
      __DATE__ " " __TIME__,
      [](sdk::Parameters parameters, char* error, std::size_t size) noexcept -> void* {
        return Factory::create(parameters, error, size);
      },
      [](void* object) noexcept { delete static_cast<Kinematics*>(object); }};
  return &kDescriptor;
}
