#include "gateway/record/flight_record.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <iterator>
#include <system_error>

#include "gateway/record/setpoint_record.hpp"

namespace rmac::gateway {
namespace {

/// Rows are handed to the system in pieces of about so much.
constexpr std::size_t kPiece = 1U << 20U;
constexpr mode_t kMode = 0640;

template <typename T>
void append_words(const std::array<T, kMaxJoints>& words, std::size_t count, std::string& out) {
  for (std::size_t i = 0; i < count; ++i) fmt::format_to(std::back_inserter(out), ",{}", words[i]);
}

void append_header(const CycleSample& sample, std::string& out) {
  const std::size_t joints = sample.joint_count_with_held;
  const std::size_t drives = sample.actuator_count;
  append_setpoint_header(joints, true, out);
  for (const char* quantity : {"ad", "effort", "force"}) append_columns(quantity, joints, out);
  for (const char* word : {"torque_permille", "load_counts", "statusword", "error_code"})
    append_columns(word, drives, out);
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
       of_joints(sample.velocity_set), of_joints(sample.acceleration_set), of_joints(sample.position)},
      out);
  append_numbers(of_joints(sample.velocity), out);
  append_numbers(of_joints(sample.effort), out);
  append_numbers(of_joints(sample.force), out);
  append_words(sample.torque_permille, drives, out);
  append_words(sample.load_counts, drives, out);
  append_words(sample.statusword, drives, out);
  append_words(sample.error_code, drives, out);
  append_numbers(sample.spindle_rpm, out);
  const ServoFault& fault = sample.fault;
  fmt::format_to(std::back_inserter(out), ",{},{},{},{},{},{},{},{},{},{},{},{}\n", sample.feed_actual_mm_s,
                 sample.cycle, to_string(sample.state), to_string(sample.servo_state), to_string(fault.kind),
                 fault.value, fault.bound, sample.inputs, sample.outputs, sample.deadline_misses, sample.horizon.s,
                 to_string(sample.horizon.limit));
}

tl::unexpected<Error> cannot(const char* what, const std::filesystem::path& path) {
  return failure(MinorCode::Other,
                 fmt::format("{}: {}: {}", path.string(), what, std::generic_category().message(errno)));
}

/// A file that is removed unless it was completed.
class NewFile {
 public:
  explicit NewFile(std::filesystem::path final_name) : final_(std::move(final_name)), path_(final_.string() + ".part") {
    descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kMode);
  }
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;
  ~NewFile() {
    if (descriptor_ < 0) return;
    ::close(descriptor_);
    ::unlink(path_.c_str());
  }

  [[nodiscard]] Expected<> write(std::string_view text) {
    if (descriptor_ < 0) return cannot("cannot be opened", path_);
    while (!text.empty()) {
      const ssize_t written = ::write(descriptor_, text.data(), text.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) return cannot("cannot be written", path_);
      text.remove_prefix(static_cast<std::size_t>(written));
    }
    return {};
  }
  [[nodiscard]] Expected<> complete() {
    // Power may go next, as after a fault it often does.
    if (::fsync(descriptor_) != 0) return cannot("cannot be written", path_);
    if (::rename(path_.c_str(), final_.c_str()) != 0) return cannot("cannot be renamed", path_);
    ::close(descriptor_);
    descriptor_ = -1;
    return {};
  }

 private:
  std::filesystem::path final_, path_;
  int descriptor_ = -1;
};

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
                      {"low_pass", joint.low_pass_hz}});
  }
  return {{"name", head.name},
          {"cause", head.cause == FlightCause::Fault ? "fault" : "demand"},
          {"message", head.message},
          {"cycle", head.cycle},
          {"t_s", head.t_s},
          {"utc", head.utc},
          {"mechanism", head.mechanism},
          {"joints", std::move(joints)},
          {"buses", head.buses},
          {"first_cycle", head.first_cycle},
          {"last_cycle", head.last_cycle}};
}

Expected<> write_flight_record(const std::filesystem::path& file, const FlightHead& head,
                               std::span<const CycleSample> samples) {
  std::error_code problem;
  std::filesystem::create_directories(file.parent_path(), problem);
  NewFile output(file);
  std::string text = to_json(head).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace) + "\n";
  if (!samples.empty()) append_header(samples.front(), text);
  for (const CycleSample& sample : samples) {
    append_row(sample, text);
    if (text.size() < kPiece) continue;
    if (auto written = output.write(text); !written) return written;
    text.clear();
  }
  return output.write(text).and_then([&] { return output.complete(); });
}

}  // namespace rmac::gateway
