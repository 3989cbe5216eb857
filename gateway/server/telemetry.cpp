#include "gateway/server/telemetry.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "gateway/api/state_json.hpp"
#include "gateway/json/printable.hpp"

namespace rmac::gateway {

namespace {

/// A number that JSON can hold: what is not finite becomes null, as JSON libraries do it.
void append_number(double value, std::string& out) {
  if (std::isfinite(value)) {
    fmt::format_to(std::back_inserter(out), "{}", value);
  } else {
    out += "null";
  }
}

void append_member(const char* name, double value, std::string& out) {
  fmt::format_to(std::back_inserter(out), ",\"{}\":", name);
  append_number(value, out);
}

void append_list(const char* name, const auto& values, std::size_t begin, std::size_t end, std::string& out) {
  fmt::format_to(std::back_inserter(out), ",\"{}\":[", name);
  for (std::size_t i = begin; i < end; ++i) {
    if (i != begin) out += ',';
    append_number(static_cast<double>(values[i]), out);
  }
  out += ']';
}

void append_head(const CycleSample& sample, std::string& out) {
  fmt::format_to(std::back_inserter(out), "{{\"cycle\":{}", sample.cycle);
  append_member("t_s", sample.t_s, out);
}

}  // namespace

void append_joints(const CycleSample& sample, std::string& out) {
  const std::size_t joints = sample.joint_count;
  const std::size_t axes = sample.axis_count;
  append_head(sample, out);
  fmt::format_to(std::back_inserter(out), ",\"moving\":{},\"move_id\":{}", sample.moving, sample.move_id);
  append_member("s_mm", sample.s_mm, out);
  append_member("feed_mm_s", sample.feed_set_mm_s, out);
  append_member("feed_actual_mm_s", sample.feed_actual_mm_s, out);
  const auto& [tip, axis] = sample.pose_set;
  append_list("pose", std::array{tip[0], tip[1], tip[2], axis[0], axis[1], axis[2]}, 0, 6, out);
  append_list("q", sample.position_set, 0, joints, out);
  append_list("qd", sample.velocity_set, 0, joints, out);
  append_list("qdd", sample.acceleration_set, 0, joints, out);
  append_list("a", sample.position, 0, joints, out);
  append_list("ad", sample.velocity, 0, joints, out);
  append_list("effort", sample.effort, 0, joints, out);
  append_list("force", sample.force, 0, joints, out);
  std::array<double, kMaxJoints> error{};
  for (std::size_t i = 0; i < axes; ++i) error[i] = sample.position_set[i] - sample.position[i];
  append_list("error", error, 0, joints, out);
  if (axes > joints) {
    append_list("held", sample.position, joints, axes, out);
    append_list("held_set", sample.position_set, joints, axes, out);
    append_list("held_effort", sample.effort, joints, axes, out);
  }
  out += '}';
}

void append_drives(const CycleSample& sample, std::string& out) {
  append_head(sample, out);
  append_list("statusword", sample.statusword, 0, sample.axis_count, out);
  out += ",\"state\":[";
  for (std::size_t i = 0; i < sample.axis_count; ++i) {
    fmt::format_to(std::back_inserter(out), "{}\"{}\"", i == 0 ? "" : ",", drive_state(sample.statusword[i]));
  }
  out += ']';
  append_list("position", sample.position, 0, sample.axis_count, out);
  fmt::format_to(std::back_inserter(out), ",\"inputs\":{},\"outputs\":{},\"deadline_misses\":{},\"samples_lost\":{}}}",
                 sample.inputs, sample.outputs, sample.deadline_misses, sample.samples_lost);
}

const char* drive_state(std::uint16_t statusword) noexcept {
  // CiA 402-2, table 29: bits 0-3, 5 and 6 tell the state.
  switch (statusword & 0x6f) {
    case 0x21:
      return "ready to switch on";
    case 0x23:
      return "switched on";
    case 0x27:
      return "operation enabled";
    case 0x07:
      return "quick stop active";
    default:
      break;
  }
  switch (statusword & 0x4f) {
    case 0x00:
      return "not ready to switch on";
    case 0x40:
      return "switch on disabled";
    case 0x0f:
      return "fault reaction active";
    case 0x08:
      return "fault";
    default:
      return "unknown";
  }
}

std::string notification(const char* topic, const std::string& params) {
  return fmt::format("{{\"jsonrpc\":\"2.0\",\"method\":\"{}\",\"params\":{}}}", topic, params);
}

std::string event_notification(const Event& event) {
  return notification("events", text_of(event_to_json(event)));
}

}  // namespace rmac::gateway
