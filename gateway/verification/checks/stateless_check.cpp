#include "gateway/verification/checks/stateless_check.hpp"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <ctime>
#include <optional>
#include <random>
#include <thread>

namespace rmac::verifier {
namespace {

constexpr std::size_t kCalls = 500;  ///< that are made again and again
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int kRepetitions = 20'000;
#else
constexpr int kRepetitions = 2'000'000;  ///< of forward and inverse each
#endif
constexpr double kRepetition_s = 4;   ///< of CPU time at most
constexpr double kBeside_s = 0.2;     ///< of CPU time, both threads together
constexpr std::size_t kLook = 1'000;  ///< calls between looks at the time

using Joints = std::vector<double>;

/// A call of the forward, one of the inverse, and what they answered at first.
struct Calls {
  Joints joints;
  Frame tool;
  ToolPose pose;
  Joints seed, answer;
  KinematicsStatus status = KinematicsStatus::Ok;
};

double cpu_time_s() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

bool same(std::span<const double> one, std::span<const double> other) {
  return std::memcmp(one.data(), other.data(), one.size_bytes()) == 0;
}

class StatelessCheck {
 public:
  StatelessCheck(const Kinematics& kinematics, const KinematicsCase& given)
      : kinematics_(kinematics), given_(given), random_(given.seed + 1) {}

  Checked run() {
    for (std::size_t i = 0; i < kCalls; ++i) calls_.push_back(first_calls(i));
    return again_and_again().and_then([&] { return from_two_threads(); });
  }

 private:
  double random(double least, double most) { return std::uniform_real_distribution<>(least, most)(random_); }

  Calls first_calls(std::size_t i) {
    constexpr double kNearby = 1e-3;
    Calls calls;
    calls.tool = given_.tools[i % given_.tools.size()];
    for (const JointRange& range : given_.ranges) {
      calls.joints.push_back(random(range.min, range.max));
      calls.seed.push_back(calls.joints.back() + random(-kNearby, kNearby));
    }
    kinematics_.forward(calls.joints, calls.tool, calls.pose);
    calls.answer.resize(calls.joints.size());
    calls.status = kinematics_.inverse(calls.pose, calls.tool, calls.seed, calls.answer);
    return calls;
  }

  /// Which function answers otherwise than at first; nullptr where none does. Any thread.
  static const char* changed(const Kinematics& kinematics, const Calls& calls, std::span<double> answer) {
    ToolPose pose;
    kinematics.forward(calls.joints, calls.tool, pose);
    if (!same(pose.tip, calls.pose.tip) || !same(pose.axis, calls.pose.axis)) return "forward";
    const KinematicsStatus status = kinematics.inverse(calls.pose, calls.tool, calls.seed, answer);
    const bool as_before = status == calls.status && (status != KinematicsStatus::Ok || same(answer, calls.answer));
    return as_before ? nullptr : "inverse";
  }

  [[nodiscard]] Checked fault(const char* function, const char* when, const Calls& calls) const {
    const auto& [tip, axis] = calls.pose;
    return found("state", std::string(function) + " answers otherwise than before to the same arguments, " + when, -1,
                 {named("joints", calls.joints),
                  {"tool",
                   {calls.tool.p[0], calls.tool.p[1], calls.tool.p[2], calls.tool.q[0], calls.tool.q[1],
                    calls.tool.q[2], calls.tool.q[3]}},
                  {"pose", {tip[0], tip[1], tip[2], axis[0], axis[1], axis[2]}},
                  named("seed", calls.seed),
                  named("answer before", calls.answer)});
  }

  Checked again_and_again() {
    Joints answer(given_.ranges.size());
    const double begun_s = cpu_time_s();
    for (int i = 0; i < kRepetitions; ++i) {
      const Calls& calls = calls_[random_() % kCalls];
      const char* const function = changed(kinematics_, calls, answer);
      if (auto proper = misdeed_or(i % static_cast<int>(kLook) == 0 ? given_.misdeed : Misdeed(), {}); !proper) {
        return proper;
      }
      if (function != nullptr) return fault(function, "after other calls: it keeps something between calls", calls);
      if (i % static_cast<int>(kLook) == 0 && cpu_time_s() - begun_s > kRepetition_s) break;
    }
    return given_.misdeed ? given_.misdeed() : Checked();
  }

  /// The same calls in two orders at once, not watched: who watches is one thread's.
  Checked from_two_threads() {
    if (given_.unwatched == nullptr) return {};
    std::atomic<bool> over{false};
    struct Found {
      const char* function = nullptr;
      std::size_t call = 0;
    };
    const double begun_s = cpu_time_s();
    const auto make_calls = [&](std::uint32_t seed, Found& found) {
      std::minstd_rand random(seed);
      Joints answer(given_.ranges.size());
      for (std::size_t made = 1; !over && found.function == nullptr; ++made) {
        found.call = random() % kCalls;
        found.function = changed(*given_.unwatched, calls_[found.call], answer);
        if (made % kLook == 0 && cpu_time_s() - begun_s > kBeside_s) break;
      }
      over = true;
    };
    Found here, there;
    std::thread beside([&] { make_calls(1, there); });
    make_calls(2, here);
    beside.join();
    for (const Found& one : {here, there}) {
      if (one.function == nullptr) continue;
      return fault(one.function, "while another thread calls it: planner and servo thread share it", calls_[one.call]);
    }
    return {};
  }

  const Kinematics& kinematics_;
  const KinematicsCase& given_;
  std::mt19937_64 random_;
  std::vector<Calls> calls_;
};

}  // namespace

Checked check_stateless(const Kinematics& kinematics, const KinematicsCase& given) {
  return StatelessCheck(kinematics, given).run();
}

}  // namespace rmac::verifier
