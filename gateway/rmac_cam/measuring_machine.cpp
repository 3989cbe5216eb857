#include "gateway/rmac_cam/measuring_machine.hpp"

#include <fmt/format.h>

#include <cmath>

#include "gateway/mechanism/mechanism.hpp"
#include "rmac/motion/frame.hpp"
#include "rmac/motion/vector.hpp"

namespace rmac::gateway {
namespace {

using sdk::ControlMode;
using sdk::MeasureParameter;

double sdk::Probing::*member(MeasureParameter number) {
  switch (number) {
    case MeasureParameter::PrehitDistance:
      return &sdk::Probing::prehit_distance_mm;
    case MeasureParameter::SearchDistance:
      return &sdk::Probing::search_distance_mm;
    case MeasureParameter::RetractDistance:
      return &sdk::Probing::retract_distance_mm;
    case MeasureParameter::ScanSpeed:
      break;
  }
  return &sdk::Probing::scan_speed_mm_s;
}

double along(const Vector& way, const Vector& from, const Vector& to) {
  return dot(way, difference(to, from));
}

}  // namespace

MeasuringMachine::MeasuringMachine(MotionSupervisor& supervisor, ServoLink& link, Cam& cam, bool assumes_part)
    : supervisor_(supervisor), link_(link), cam_(cam), assumes_part_(assumes_part) {}

void MeasuringMachine::mechanism_changed(const sdk::DeviceObject* device, bool fresh) {
  device_ = device;
  finder_.restart();
  if (!fresh) return;
  settings_ = device != nullptr ? device->probing : sdk::Probing{};
  mode_ = ControlMode::AutomaticMove;
  supervisor_.expect_hits_by_hand(false);
  last_hit_.reset();
  new_hit_ = false;
  spins_until_s_.reset();
}

bool MeasuringMachine::probe_active() const {
  if (device_ == nullptr) return false;
  return supervisor_.mechanism()->virtual_mode() || link_.status.read().probe.ready;
}

Expected<> MeasuringMachine::require_probe(const char* function) const {
  if (auto loaded = cam_.require_mechanism(function); !loaded) return loaded;
  if (mode_ == ControlMode::Inactive || mode_ == ControlMode::Shutdown) {
    return failure(MinorCode::ProbeNotArmed,
                   fmt::format("{}: measuring is switched off; set ControlMode to MODE_STARTUP first", function));
  }
  if (probe_active()) return {};
  return failure(
      MinorCode::ProbeNotArmed,
      device_->inputs.contains("Probe")
          ? fmt::format("{}: the probe has no power; switch it on, with SpinProbe if it is one that is spun", function)
          : fmt::format("{}: {} has no probe, which would be an input named Probe of its DigitalIOInterface", function,
                        device_->name));
}

Expected<> MeasuringMachine::require_settled_probe(const char* function) const {
  return require_probe(function).and_then([&]() -> Expected<> {
    if (!link_.status.read().probe.touching) return {};
    return failure(MinorCode::ProbeNotArmed, fmt::format("{}: the probe touches something; jog it free", function));
  });
}

Expected<ToolPose> MeasuringMachine::queue_end() {
  return supervisor_.prepare_move().map([&] { return supervisor_.mechanism()->builder.end_pose(); });
}

Expected<> MeasuringMachine::move_to_point(std::int64_t id, const Vector& point, double speed) {
  constexpr const char* kFunction = "MoveToXYZ";
  const auto from = queue_end();
  if (!from) return tl::unexpected(from.error());
  return cam_.path_move_at(kFunction, id, PathTargetGeometry{{point, from->axis}}, speed)
      .and_then([&](const Move& move) { return supervisor_.add_move(move); })
      .map([](bool) {});
}

Expected<> MeasuringMachine::move_in_arc(std::int64_t id, const sdk::ArcTo& arc, double speed) {
  constexpr const char* kFunction = "MoveInArc";
  const auto from = queue_end();
  if (!from) return tl::unexpected(from.error());
  constexpr double kSamePoint_mm = 1e-6;
  const Vector gap{arc.end[0] - from->tip[0], arc.end[1] - from->tip[1], arc.end[2] - from->tip[2]};
  const bool closed = std::hypot(gap[0], gap[1], gap[2]) < kSamePoint_mm;
  const ArcGeometry geometry{arc.center, arc.normal, 1, closed, *from, {arc.end, from->axis}};
  return cam_.path_move_at(kFunction, id, geometry, speed)
      .and_then([&](const Move& move) { return supervisor_.add_move(move); })
      .map([](bool) {});
}

Expected<> MeasuringMachine::move_all_axes(std::int64_t id, std::vector<double> joints, double speed) {
  return cam_.queue_joints_at("MoveAllAxis", id, JointTargetGeometry{std::move(joints)}, speed);
}

Expected<> MeasuringMachine::move_rotary_axis(std::int64_t id, int joint, double position, int direction,
                                              double speed) {
  constexpr const char* kFunction = "MoveRotaryAxis";
  const auto found = cam_.find_joint(joint, kFunction);
  if (!found) return tl::unexpected(found.error());
  const JointLimits& limits = device_->joints[*found].limits;
  if (limits.type != JointType::Rotary) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("{}: joint {} ({}) does not turn; use MoveAllAxis", kFunction, joint, limits.name));
  }
  if (auto ready = supervisor_.prepare_move(); !ready) return ready;
  const std::span<const double> end = supervisor_.mechanism()->builder.end_joints();
  JointTargetGeometry target{{end.begin(), end.end()}};
  const double from = target.joints[*found];
  // The same attitude comes back with every turn: of those places, the nearest in the sense that is asked for.
  constexpr double kTurn = 360, kThere = 1e-9;
  std::optional<double> nearest;
  const double first = position + kTurn * std::round((from - position) / kTurn);
  for (const double place : {first - kTurn, first, first + kTurn}) {
    const double way = place - from;
    const bool inside = !(ends_below(limits) && place < limits.min) && !(ends_above(limits) && place > limits.max);
    const bool sense = direction == 0 || std::abs(way) < kThere || (direction > 0) == (way > 0);
    if (inside && sense && (!nearest || std::abs(way) < std::abs(*nearest - from))) nearest = place;
  }
  if (!nearest) {
    return failure(
        MinorCode::TravelLimit,
        fmt::format("{}: joint {} cannot turn from {:.6g} to {:.6g} degrees {} within its travel from {:.6g} "
                    "to {:.6g}",
                    kFunction, limits.name, from, position,
                    direction == 0  ? "either way"
                    : direction > 0 ? "in the positive sense"
                                    : "in the negative sense",
                    limits.min, limits.max));
  }
  target.joints[*found] = *nearest;
  return cam_.queue_joints_at(kFunction, id, target, speed);
}

Expected<> MeasuringMachine::auto_measure(std::int64_t id, const Vector& point, double speed) {
  constexpr const char* kFunction = "AutoMeasure";
  if (auto ready = require_settled_probe(kFunction); !ready) return ready;
  const auto from = queue_end();
  if (!from) return tl::unexpected(from.error());
  const Vector way{point[0] - from->tip[0], point[1] - from->tip[1], point[2] - from->tip[2]};
  const double length = std::hypot(way[0], way[1], way[2]);
  if (!std::isfinite(length) || !(length > 1e-6)) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("{}: the tip stands at the point already, so there is no direction to search in; move "
                               "away from the surface first",
                               kFunction));
  }
  const Vector direction{way[0] / length, way[1] / length, way[2] / length};
  const double approach_mm = length - settings_.prehit_distance_mm;
  const auto target = [&](double mm) { return PathTargetGeometry{{plus(from->tip, mm, direction), from->axis}}; };
  std::optional<Move> approach;
  if (approach_mm > 1e-6) {
    auto made = cam_.path_move_at(kFunction, id, target(approach_mm), speed);
    if (!made) return tl::unexpected(made.error());
    approach = std::move(*made);
  }
  const auto search = cam_.path_move_at(kFunction, id, target(length + settings_.search_distance_mm),
                                        std::min(speed, settings_.scan_speed_mm_s));
  if (!search) return tl::unexpected(search.error());
  const Point before = std::exchange(point_, Point{id, from->tip, direction, speed, length, {}});
  auto queued = supervisor_.add_measurement(approach, *search);
  if (!queued) point_ = before;
  return queued;
}

void MeasuringMachine::take(const HitFinder::Found& found) {
  last_hit_ = sdk::Hit{found.t_s, found.joints, cam_.tool_pose_at(found.joints)};
  new_hit_ = true;
  point_.hit = last_hit_;
}

void MeasuringMachine::assume_hit(const CycleSample& sample) {
  const Measurement::Phase phase = supervisor_.measurement();
  if (phase == Measurement::Phase::Standing) supervisor_.simulate_probe(false);
  if (phase != Measurement::Phase::Search || point_.hit) return;
  if (along(point_.direction, point_.from, sample.pose_set.tip) < point_.length_mm) return;
  take({sample.t_s, {sample.position_set.begin(), sample.position_set.begin() + sample.joint_count}});
  untold_.push_back(*last_hit_);
  supervisor_.simulate_probe(true);
}

void MeasuringMachine::read(const CycleSample& sample, const std::function<void(Event)>& tell) {
  if (device_ == nullptr) return;
  if (assumes_part_) assume_hit(sample);
  const auto found = finder_.read(sample);
  if (found) {
    take(*found);
    untold_.push_back(*last_hit_);
  }
  for (const sdk::Hit& hit : untold_) {
    const Vector& tip = hit.pose.tip;
    Event event;
    event.kind = Event::Kind::Hit;
    event.t_s = hit.t_s;
    event.move_id = sample.move_id;
    event.message = fmt::format("the probe touched with the tip at {:.6f}, {:.6f}, {:.6f} mm", tip[0], tip[1], tip[2]);
    event.cycle = sample.cycle;
    event.hit = hit;
    tell(std::move(event));
  }
  untold_.clear();
}

void MeasuringMachine::advance() {
  if (device_ == nullptr) return;
  if (spins_until_s_ && link_.status.read().t_s >= *spins_until_s_) {
    spins_until_s_.reset();
    supervisor_.set_spindle(0, 0);
  }
  if (supervisor_.measurement() != Measurement::Phase::Standing || !point_.hit) return;
  const ToolPose stands = cam_.tool_pose_set();
  // From the hit, but never further than where the approach began: what lies behind is not known.
  const double hit_mm = along(point_.direction, point_.from, point_.hit->pose.tip);
  const double back_to_mm = std::max(hit_mm - settings_.retract_distance_mm, 0.0);
  const double here_mm = along(point_.direction, point_.from, stands.tip);
  const PathTargetGeometry target{{plus(stands.tip, back_to_mm - here_mm, point_.direction), stands.axis}};
  // A refusal passes: the machine is still coming to rest, or its drives are.
  (void)cam_.path_move_at("AutoMeasure", point_.id, target, point_.speed).and_then([&](const Move& move) {
    return supervisor_.add_retract(move);
  });
}

Expected<> MeasuringMachine::manual_measure() {
  return require_probe("ManualMeasure").map([&] {
    mode_ = ControlMode::Manual;
    supervisor_.expect_hits_by_hand(true);
  });
}

Expected<> MeasuringMachine::spin_probe(double rpm, double seconds) {
  constexpr const char* kFunction = "SpinProbe";
  if (auto found = cam_.find_spindle(0, kFunction); !found) return tl::unexpected(found.error());
  if (!std::isfinite(seconds) || !(seconds > 0)) {
    return failure(MinorCode::InvalidParameterValue, fmt::format("{}: {} s must be above 0", kFunction, seconds));
  }
  return supervisor_.require_rest(kFunction).and_then([&] { return cam_.set_spindle_rpm(0, rpm); }).map([&] {
    spins_until_s_ = link_.status.read().t_s + seconds;
  });
}

Expected<> MeasuringMachine::simulate_probe(std::vector<double> joints, bool touching) {
  constexpr const char* kFunction = "SendConditionChangedEvent";
  if (auto ready = require_probe(kFunction); !ready) return ready;
  if (!supervisor_.mechanism()->virtual_mode()) {
    return failure(
        MinorCode::UnsupportedOperation,
        fmt::format("{}: the drives are live, and a hit is the probe's to tell; load the mechanism in virtual "
                    "mode to simulate one",
                    kFunction));
  }
  if (joints.size() != device_->joints.size()) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("{}: {} joint values are given, and the mechanism has {} joints", kFunction,
                               joints.size(), device_->joints.size()));
  }
  if (touching) {
    take({link_.status.read().t_s, std::move(joints)});
    untold_.push_back(*last_hit_);
  }
  supervisor_.simulate_probe(touching);
  return {};
}

Expected<> MeasuringMachine::set_calibrated_part_frame() {
  constexpr const char* kFunction = "SetCalibratedPartFrame";
  if (auto loaded = cam_.require_mechanism(kFunction); !loaded) return loaded;
  return supervisor_.require_rest(kFunction).and_then([&] {
    const ToolPose here = cam_.tool_pose_in_machine();
    return cam_.set_part_frame(frame_from_axis(here.tip, here.axis));
  });
}

Expected<sdk::Hit> MeasuringMachine::last_hit() {
  if (!last_hit_) {
    return failure(MinorCode::Other,
                   "LastHitPosition: the probe has not touched anything since the mechanism was loaded");
  }
  new_hit_ = false;
  return *last_hit_;
}

ControlMode MeasuringMachine::control_mode() const {
  if (device_ == nullptr) return ControlMode::Inactive;
  return supervisor_.measurement() == Measurement::Phase::None ? mode_ : ControlMode::AutomaticMeasure;
}

Expected<> MeasuringMachine::set_control_mode(ControlMode mode) {
  constexpr const char* kFunction = "ControlMode";
  if (auto rest = supervisor_.require_rest(kFunction); !rest) return rest;
  if (mode == ControlMode::Manual) {
    if (mode_ != ControlMode::Inactive && mode_ != ControlMode::Shutdown) return manual_measure();
  }
  if (auto loaded = cam_.require_mechanism(kFunction); !loaded) return loaded;
  const ControlMode before = mode_;
  mode_ = mode;
  if (mode == ControlMode::Startup) {
    if (auto ready = require_settled_probe(kFunction); !ready) {
      mode_ = before;
      return ready;
    }
    mode_ = ControlMode::AutomaticMove;
    new_hit_ = false;
  } else if (mode != ControlMode::Inactive && mode != ControlMode::Shutdown) {
    if (auto ready = require_probe(kFunction); !ready) {
      mode_ = before;
      return ready;
    }
  }
  supervisor_.expect_hits_by_hand(mode_ == ControlMode::Manual);
  return {};
}

double MeasuringMachine::parameter(MeasureParameter number) const {
  return settings_.*member(number);
}

Expected<> MeasuringMachine::set_parameter(MeasureParameter number, double value) {
  if (!std::isfinite(value) || !(value > 0)) {
    return failure(MinorCode::InvalidParameterValue, fmt::format("Parameter: {} must be above 0", value));
  }
  settings_.*member(number) = value;
  return {};
}

}  // namespace rmac::gateway
