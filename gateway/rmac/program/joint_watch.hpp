#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gateway/rmac/program/record.hpp"
#include "gateway/rmac/wire/connection.hpp"

namespace rmac::cli {

/// The joints as the appliance tells them while a program runs: how far they are from where they are to be, and the
/// record of them.
class JointWatch {
 public:
  using OnCycle = std::function<void(const JointSample&)>;

  /// An empty `record_file`: no record. `on_cycle`, where there is one, hears every cycle that a record would hold.
  explicit JointWatch(const std::string& record_file, OnCycle on_cycle = {});

  /// Makes the record's file, if there is to be one.
  [[nodiscard]] Result<> open();
  /// Has the joints told from now on: every cycle of them for a record. The second time it does nothing.
  [[nodiscard]] Result<> begin(Connection& connection);
  /// What the topic `joints` tells.
  [[nodiscard]] Result<> take(const nlohmann::json& params);
  /// Closes the record; an error where it lacks cycles.
  [[nodiscard]] Result<> close();

  /// All is to be seen up to the machine's time `t_s`, and is not yet.
  [[nodiscard]] bool waits_for(double t_s) const { return sees_every_cycle() && last_sample_s_ < t_s; }

  /// Largest seen of each joint, mm or deg.
  [[nodiscard]] const std::vector<double>& following_error() const noexcept { return following_error_; }
  /// False: what is seen are samples, not all cycles.
  [[nodiscard]] bool sees_every_cycle() const noexcept { return watching_ && wants_every_cycle(); }
  [[nodiscard]] const std::optional<Record>& record() const noexcept { return record_; }

 private:
  [[nodiscard]] bool wants_every_cycle() const noexcept { return record_ || on_cycle_; }
  [[nodiscard]] Result<> take(const JointSample& sample);

  std::optional<Record> record_;
  OnCycle on_cycle_;
  bool begun_ = false;  ///< something moved
  std::vector<double> following_error_;
  double last_sample_s_ = 0;
  bool watching_ = false;
};

}  // namespace rmac::cli
