#include "gateway/server/telemetry.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "gateway/api/state_json.hpp"
#include "gateway/json/printable.hpp"
#include "rmac/motion/drive_power.hpp"

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
  const std::size_t with_held = sample.joint_count_with_held;
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
  if (sample.truth) append_list("truth", *sample.truth, 0, joints, out);
  append_list("effort", sample.effort, 0, joints, out);
  append_list("force", sample.force, 0, joints, out);
  append_list("error", sample.following_error, 0, joints, out);
  if (with_held > joints) {
    append_list("held", sample.position, joints, with_held, out);
    append_list("held_set", sample.position_set, joints, with_held, out);
    append_list("held_error", sample.following_error, joints, with_held, out);
    append_list("held_effort", sample.effort, joints, with_held, out);
    if (sample.truth) append_list("held_truth", *sample.truth, joints, with_held, out);
  }
  out += '}';
}

void append_drives(const CycleSample& sample, std::string& out) {
  append_head(sample, out);
  append_list("statusword", sample.statusword, 0, sample.actuator_count, out);
  out += ",\"state\":[";
  for (std::size_t i = 0; i < sample.actuator_count; ++i) {
    fmt::format_to(std::back_inserter(out), "{}\"{}\"", i == 0 ? "" : ",", drive_state_text(sample.statusword[i]));
  }
  out += ']';
  append_list("ahead", sample.ahead, 0, sample.actuator_count, out);
  append_list("position", sample.position, 0, sample.joint_count_with_held, out);
  fmt::format_to(std::back_inserter(out), ",\"inputs\":{},\"outputs\":{},\"deadline_misses\":{},\"samples_lost\":{}}}",
                 sample.inputs, sample.outputs, sample.deadline_misses, sample.samples_lost);
}

void append_frame(const Frame& frame, std::string& out) {
  const auto append = [&](char before, const auto& values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      out += i == 0 ? before : ',';
      append_number(values[i], out);
    }
  };
  out += R"({"p":)";
  append('[', frame.p);
  out += R"(],"q":)";
  append('[', frame.q);
  out += "]}";
}

void append_animation(const CycleSample& sample, const LinkPoses& links, std::string& out) {
  append_head(sample, out);
  fmt::format_to(std::back_inserter(out), ",\"moving\":{},\"move_id\":{}", sample.moving, sample.move_id);
  const auto& [tip, axis] = sample.pose_actual;
  append_list("pose", std::array{tip[0], tip[1], tip[2], axis[0], axis[1], axis[2]}, 0, 6, out);
  append_list("joints", sample.position, 0, sample.joint_count, out);
  if (sample.joint_count_with_held > sample.joint_count) {
    append_list("held", sample.position, sample.joint_count, sample.joint_count_with_held, out);
  }
  std::array<Frame, kMaxJoints + 3> poses{};  // base, spindle and table beside the joints
  links.at(std::span(sample.position).first(links.joint_count()), poses);
  out += ",\"links\":";
  char before = '{';
  for (std::size_t i = 0; i < links.names().size(); ++i) {
    fmt::format_to(std::back_inserter(out), "{}{}:", std::exchange(before, ','), text_of(links.names()[i]));
    append_frame(poses[i], out);
  }
  out += "}}";
}

std::string notification(const char* topic, const std::string& params) {
  return fmt::format("{{\"jsonrpc\":\"2.0\",\"method\":\"{}\",\"params\":{}}}", topic, params);
}

std::string event_notification(const Event& event) {
  return notification("events", text_of(event_to_json(event)));
}

}  // namespace rmac::gateway
