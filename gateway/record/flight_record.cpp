#include "gateway/record/flight_record.hpp"

#include <fmt/format.h>

#include <iterator>
#include <system_error>

#include "gateway/files/whole_file.hpp"
#include "gateway/record/setpoint_record.hpp"

namespace rmac::gateway {
namespace {

/// Rows are handed to the system in pieces of about so much.
constexpr std::size_t kPiece = 1U << 20U;
constexpr mode_t kRights = 0640;

template <typename T>
void append_words(const std::array<T, kMaxJoints>& words, std::size_t count, std::string& out) {
  for (std::size_t i = 0; i < count; ++i) fmt::format_to(std::back_inserter(out), ",{}", words[i]);
}

/// Some of its motors move a joint side by side.
bool has_gantry(const CycleSample& sample) {
  return sample.actuator_count > sample.joint_count_with_held;
}

void append_header(const CycleSample& sample, std::string& out) {
  const std::size_t joints = sample.joint_count_with_held;
  const std::size_t drives = sample.actuator_count;
  append_setpoint_header(joints, true, out);
  for (const char* quantity : {"ad", "effort", "force"}) append_columns(quantity, joints, out);
  if (sample.truth) append_columns("truth", joints, out);
  for (const char* word : {"torque_permille", "counts", "statusword", "error_code"}) append_columns(word, drives, out);
  if (has_gantry(sample)) append_columns("ahead", drives, out);
  append_columns("rpm", sample.spindle_rpm.size(), out);
  out +=
      ",feed_actual_mm_s,cycle,state,servo_state,fault,fault_value,fault_bound,inputs,outputs,deadline_misses,"
      "horizon_s,horizon_limit\n";
}

void append_row(const CycleSample& sample, std::string& out) {
  const std::size_t joints = sample.joint_count_with_held;
  const std::size_t drives = sample.actuator_count;
  const auto of_joints = [joints](const std::array<double, kMaxJoints>& values) {
    return std::span(values).first(joints);
  };
  const auto& [tip, axis] = sample.pose_set;
  const std::array pose{tip[0], tip[1], tip[2], axis[0], axis[1], axis[2]};
  append_setpoint_row(
      {sample.t_s, sample.move_id, sample.s_mm, sample.feed_set_mm_s, pose, of_joints(sample.position_set),
       of_joints(sample.velocity_set), of_joints(sample.acceleration_set), of_joints(sample.position),
       of_joints(sample.following_error)},
      out);
  append_numbers(of_joints(sample.velocity), out);
  append_numbers(of_joints(sample.effort), out);
  append_numbers(of_joints(sample.force), out);
  if (sample.truth) append_numbers(of_joints(*sample.truth), out);
  append_words(sample.torque_permille, drives, out);
  append_words(sample.counts, drives, out);
  append_words(sample.statusword, drives, out);
  append_words(sample.error_code, drives, out);
  if (has_gantry(sample)) append_numbers(std::span(sample.ahead).first(drives), out);
  append_numbers(sample.spindle_rpm, out);
  const ServoFault& fault = sample.fault;
  fmt::format_to(std::back_inserter(out), ",{},{},{},{},{},{},{},{},{},{},{},{}\n", sample.feed_actual_mm_s,
                 sample.cycle, to_string(sample.state), to_string(sample.servo_state), to_string(fault.kind),
                 fault.value, fault.bound, sample.inputs, sample.outputs, sample.deadline_misses, sample.horizon.s,
                 to_string(sample.horizon.limit));
}

nlohmann::json to_json(const Cogging& cogging) {
  nlohmann::json list = nlohmann::json::array();
  for (const Cogging::Harmonic& one : cogging.harmonics) {
    list.push_back({{"order", one.order}, {"cosine", one.cosine_nm}, {"sine", one.sine_nm}});
  }
  return {{"lead", cogging.lead_s}, {"harmonics", std::move(list)}};
}

nlohmann::json to_json(const std::vector<Resonance>& resonances) {
  nlohmann::json list = nlohmann::json::array();
  for (const Resonance& one : resonances) {
    list.push_back({{"frequency", one.frequency_hz}, {"damping", one.damping}, {"width", one.width}});
  }
  return list;
}

}  // namespace

nlohmann::json to_json(const FlightHead& head) {
  nlohmann::json joints = nlohmann::json::array();
  for (const FlightHead::Joint& joint : head.joints) {
    joints.push_back({{"name", joint.name},
                      {"unit", joint.unit},
                      {"law", joint.law},
                      {"gains", joint.gains},
                      {"parameters", joint.parameters},
                      {"max_speed", joint.max_speed},
                      {"max_acceleration", joint.max_acceleration},
                      {"max_effort", joint.max_effort},
                      {"resonances", to_json(joint.resonances)},
                      {"low_pass", joint.low_pass_hz},
                      {"answer_delay", joint.answer_delay}});
  }
  nlohmann::json actuators = nlohmann::json::array();
  for (const auto& [scale, cogging] : head.actuators) {
    actuators.push_back({{"counts_per_revolution", scale.counts_per_revolution},
                         {"rated_torque", scale.rated_torque_nm},
                         {"direction", scale.direction},
                         {"cogging", to_json(cogging)}});
  }
  return {{"name", head.name},
          {"cause", head.cause == FlightCause::Fault ? "fault" : "demand"},
          {"message", head.message},
          {"cycle", head.cycle},
          {"t_s", head.t_s},
          {"utc", head.utc},
          {"mechanism", head.mechanism},
          {"joints", std::move(joints)},
          {"actuators", std::move(actuators)},
          {"buses", head.buses},
          {"first_cycle", head.first_cycle},
          {"last_cycle", head.last_cycle}};
}

Expected<> write_flight_record(const std::filesystem::path& file, const FlightHead& head,
                               std::span<const CycleSample> samples) {
  std::error_code problem;
  std::filesystem::create_directories(file.parent_path(), problem);
  WholeFile output(file, kRights);
  std::string text = to_json(head).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace) + "\n";
  if (!samples.empty()) append_header(samples.front(), text);
  for (const CycleSample& sample : samples) {
    append_row(sample, text);
    if (text.size() < kPiece) continue;
    output.write(text);
    if (!output.good()) break;
    text.clear();
  }
  output.write(text);
  return output.finish();
}

}  // namespace rmac::gateway
