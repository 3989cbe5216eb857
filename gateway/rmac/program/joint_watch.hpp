#pragma once

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
  /// An empty `record_file`: no record.
  explicit JointWatch(const std::string& record_file);

  /// Makes the record's file, if there is to be one.
  [[nodiscard]] Result<> open();
  /// Has the joints told from now on: every cycle of them for a record. The second time it does nothing.
  [[nodiscard]] Result<> begin(Connection& connection);
  /// What the topic `joints` tells.
  [[nodiscard]] Result<> take(const nlohmann::json& params);
  /// Closes the record; an error where it lacks cycles.
  [[nodiscard]] Result<> close();

  /// A record is to hold all up to the machine's time `t_s`, and does not yet.
  [[nodiscard]] bool waits_for(double t_s) const { return record_ && watching_ && last_sample_s_ < t_s; }

  /// Largest seen of each joint, mm or deg.
  [[nodiscard]] const std::vector<double>& following_error() const noexcept { return following_error_; }
  /// False: what is seen are samples, not all cycles.
  [[nodiscard]] bool sees_every_cycle() const noexcept { return watching_ && record_; }
  [[nodiscard]] const std::optional<Record>& record() const noexcept { return record_; }

 private:
  [[nodiscard]] Result<> take(const JointSample& sample);

  std::optional<Record> record_;
  std::vector<double> following_error_;
  double last_sample_s_ = 0;
  bool watching_ = false;
};

}  // namespace rmac::cli
