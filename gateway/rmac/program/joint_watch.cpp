#include "gateway/rmac/program/joint_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "gateway/rmac/wire/requests.hpp"

namespace rmac::cli {

namespace {

constexpr double kFullRateHz = 1e6;  // More than any cycle: the appliance gives its own full rate.
constexpr double kWatchRateHz = 100;

}  // namespace

JointWatch::JointWatch(const std::string& record_file, OnCycle on_cycle) : on_cycle_(std::move(on_cycle)) {
  if (!record_file.empty()) record_.emplace(record_file);
}

Result<> JointWatch::open() {
  return record_ ? record_->open() : Result<>();
}

Result<> JointWatch::begin(Connection& connection) {
  if (watching_) return {};
  watching_ = true;
  return subscribe(connection, kJointsTopic, wants_every_cycle() ? kFullRateHz : kWatchRateHz);
}

Result<> JointWatch::take(const nlohmann::json& params) {
  for (const JointSample& sample : read_joints(params)) {
    if (auto taken = take(sample); !taken) return taken;
  }
  return {};
}

Result<> JointWatch::take(const JointSample& sample) {
  last_sample_s_ = sample.t_s;
  following_error_.resize(std::max(following_error_.size(), sample.position_set.size()));
  for (std::size_t joint = 0; joint < std::min(sample.position_set.size(), sample.following_error.size()); ++joint) {
    following_error_[joint] = std::max(following_error_[joint], std::abs(sample.following_error[joint]));
  }
  // Waiting for the first move is no part of the record; every cycle from there on is.
  begun_ = begun_ || sample.moving;
  if (begun_ && on_cycle_) on_cycle_(sample);
  return begun_ && record_ ? record_->add(sample) : Result<>();
}

Result<> JointWatch::close() {
  if (!record_) return {};
  if (auto closed = record_->close(); !closed) return closed;
  if (record_->missing_cycles() == 0) return {};
  return fail(fmt::format("the record lacks {} cycles: another client has the full rate", record_->missing_cycles()));
}

}  // namespace rmac::cli
