#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "gateway/chatter/vibration_mode.hpp"
#include "gateway/dynamics/closed_loops.hpp"
#include "gateway/dynamics/path_deviation.hpp"
#include "gateway/state/cycle_sample.hpp"
#include "rmac/fieldbus/simulated_interface.hpp"

namespace rmac::gateway {

/// Where a joint really was against where it was to be, mm or degrees; all the time from the first motion to the last.
struct JointDeviation {
  std::string name;
  bool rotary = false;
  double peak = 0, rms = 0;
};

/// What a motor gave at its shaft, N·m, over the same time.
struct MotorTorque {
  std::string bus;
  std::uint32_t axis = 0;
  double rated_nm = 0;
  double peak_nm = 0, rms_nm = 0;
  double peak_t_s = 0;    ///< when it gave the most
  double allowed_nm = 0;  ///< beyond it the machine stops: `MaxMeasuredTorque`

  /// For ever at what it gave in the mean, it grows too hot.
  [[nodiscard]] bool overheats() const noexcept { return rms_nm > rated_nm; }
};

/// What stopped the machine, where the program did not.
struct StoppedByFault {
  int line = 0;  ///< of the program; 0: on the way to where it begins
  std::int64_t move_id = 0;
  double t_s = 0;
  std::string why;
};

/// What a machine's axes make of a planned motion: its servo loops, closed over the models of its axes as
/// `device.json` has them (docs/simulated-bus.md), are given the setpoints of each cycle, and the tool is pushed. Pitch
/// errors that a joint declares it has; a backlash too, unless the model of its axis has play of its own.
/// Spindles stand: what turns them is not looked at. One thread.
class AxisDynamics {
 public:
  /// Refused where not each drive is simulated or has a model, or the loops do not come up.
  [[nodiscard]] static Expected<std::unique_ptr<AxisDynamics>> open(const sdk::DeviceObject& device,
                                                                    const ModuleLoader& loader, double period_s);

  /// What is beside the setpoints of a cycle.
  struct Beside {
    int line = 0;                      ///< of the program
    Frame tool{};                      ///< its tip on the tool interface
    Eigen::Vector3d force_n{0, 0, 0};  ///< on the tool, in the frame of the link that holds the part
    Eigen::Vector3d bend_mm{0, 0, 0};  ///< of the tool, there: by so much its tip is beside where the joints have it
  };
  /// One cycle of this mechanism's planned motion. Before the first, the joints are brought to where that begins. After
  /// a fault nothing changes any more.
  void cycle(const CycleSample& planned, const Beside& beside);
  /// The tool is another.
  void forget_path() { deviation_.forget(), way_ = {}; }
  /// The motion is over.
  void finish();
  /// As `PathDeviation::on_judged`.
  void on_deviation(std::function<void(double t_s, double off_mm)> told) { deviation_.on_judged(std::move(told)); }

  /// Where the joints are in truth: behind what bends and sticks, whatever encoders tell. Those of the kinematics.
  [[nodiscard]] std::span<const double> joints() const noexcept;
  /// What their servo loops tell: where encoders have them, and how far from where they were wanted.
  [[nodiscard]] const ServoReport& report() const noexcept { return loops_->report(); }
  /// How a tip swings with the axes that bend, each of them motor against load as if no loop held either, with the
  /// joints where they are; in the frame of the link that holds the part. Empty: all are rigid.
  [[nodiscard]] std::vector<VibrationMode> modes(const Frame& tool) const;
  /// What a motor gives at its shaft, as its drive tells it.
  [[nodiscard]] double torque_nm(std::size_t motor) const;
  [[nodiscard]] const std::optional<StoppedByFault>& stopped() const noexcept { return stopped_; }
  [[nodiscard]] std::vector<JointDeviation> joint_deviations() const;
  [[nodiscard]] std::vector<MotorTorque> motor_torques() const;
  [[nodiscard]] const PathDeviation& deviation() const noexcept { return deviation_; }

 private:
  struct Mean {
    double peak = 0, peak_t_s = 0, sum2 = 0;
    void add(double t_s, double value) noexcept;
  };
  /// One drive: where it hangs on its bus's model.
  struct Motor {
    fieldbus::SimulatedInterface* bus;
    std::uint32_t axis;
  };

  AxisDynamics(std::unique_ptr<ClosedLoops> loops, std::vector<Motor> motors, const sdk::DeviceObject& device);
  void find_plays();
  void approach(const CycleSample& planned);
  void push(const Beside& beside);
  /// What motors feel at their shafts of a force on the tip, N·m, as joints turn them.
  [[nodiscard]] std::array<double, kMaxJoints> torques_of(const Eigen::Vector3d& force_n, const Frame& tool) const;
  /// Shaft angles of the loads as they are now.
  [[nodiscard]] std::array<double, kMaxJoints> loads() const;
  void see_truth(const std::array<double, kMaxJoints>& loads);
  void account(const CycleSample& planned, const Beside& beside);
  void run(const CycleSample& planned, int line);
  /// Of what the tool bends by, what is beside its way; along it the tip only comes sooner or later.
  [[nodiscard]] Eigen::Vector3d beside_way(const Eigen::Vector3d& bend_mm, const Eigen::Vector3d& planned);
  [[nodiscard]] Eigen::Vector3d tip(std::span<const double> joints, const Frame& tool) const;
  [[nodiscard]] const Kinematics& kinematics() const noexcept { return *loops_->mechanism().planner_model.kinematics; }

  std::unique_ptr<ClosedLoops> loops_;
  std::vector<Motor> motors_;
  sdk::DeviceObject device_;  ///< as it was before its drives were put on models
  std::array<double, kMaxJoints> truth_{};
  std::array<bool, kMaxJoints> plays_{};  ///< joints whose motors' models have play
  bool begun_ = false, moved_ = false, pushed_ = false;
  std::vector<Mean> joints_, torques_;
  std::size_t count_ = 0;
  PathDeviation deviation_;
  struct Way {
    std::optional<Eigen::Vector3d> last;  ///< planned tip
    Eigen::Vector3d along{0, 0, 0};       ///< unit
  };
  Way way_;
  std::optional<StoppedByFault> stopped_;
};

}  // namespace rmac::gateway
