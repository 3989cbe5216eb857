#include "gateway/rmac/program/record.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "gateway/record/setpoint_record.hpp"

namespace rmac::cli {

namespace {

constexpr std::size_t kPoseNumbers = 6;

Result<> write_failure(const std::string& file) {
  return fail(fmt::format("{}: the record cannot be written: {}", file, std::generic_category().message(errno)));
}

}  // namespace

std::string Record::name_of(std::size_t number) const {
  if (number <= 1) {
    return file_;
  }
  const std::filesystem::path path(file_);
  return (path.parent_path() / fmt::format("{}-{}{}", path.stem().string(), number, path.extension().string()))
      .string();
}

Result<> Record::open() {
  files_.push_back(file_);
  output_.open(file_, std::ios::trunc);
  return output_ ? Result<>() : write_failure(file_);
}

Result<> Record::start_file(std::size_t joints, bool measured) {
  if (joints_ != 0) {
    if (auto closed = close(); !closed) {
      return closed;
    }
    files_.push_back(name_of(files_.size() + 1));
    output_.open(files_.back(), std::ios::trunc);
  }
  joints_ = joints;
  row_.clear();
  gateway::append_setpoint_header(joints, measured, row_);
  row_ += '\n';
  output_ << row_;
  return output_ ? Result<>() : write_failure(files_.back());
}

Result<> Record::add(const JointSample& sample) {
  const auto joints = sample.position_set.size();
  if (joints == 0) {
    return {};
  }
  const bool measured = !sample.position.empty();
  if (sample.pose.size() != kPoseNumbers || sample.velocity_set.size() != joints ||
      sample.acceleration_set.size() != joints ||
      (measured && (sample.position.size() != joints || sample.following_error.size() != joints))) {
    return fail("the appliance sent a joints sample whose lists differ in length: the record would be wrong");
  }
  if (last_cycle_ >= 0 && sample.cycle > last_cycle_ + 1) {
    missing_ += sample.cycle - last_cycle_ - 1;
  }
  last_cycle_ = sample.cycle;
  if (joints != joints_) {
    if (auto started = start_file(joints, measured); !started) {
      return started;
    }
  }
  row_.clear();
  gateway::append_setpoint_row(
      {sample.t_s, sample.move_id, sample.s_mm, sample.feed_mm_s, sample.pose, sample.position_set, sample.velocity_set,
       sample.acceleration_set, sample.position, sample.following_error},
      row_);
  row_ += '\n';
  output_ << row_;
  ++rows_;
  return output_ ? Result<>() : write_failure(files_.back());
}

Result<> Record::close() {
  output_.close();
  return output_ ? Result<>() : write_failure(files_.back());
}

}  // namespace rmac::cli
