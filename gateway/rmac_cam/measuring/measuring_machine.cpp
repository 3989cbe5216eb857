#include "gateway/rmac_cam/measuring/measuring_machine.hpp"

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

}  // namespace

MeasuringMachine::MeasuringMachine(MotionSupervisor& supervisor, ServoLink& link, Cam& cam, bool assumes_part)
    : supervisor_(supervisor), link_(link), cam_(cam), tool_(supervisor, link), assumes_part_(assumes_part) {}

double MeasuringMachine::Point::way_to(const Vector& tip) const {
  return dot(direction, difference(tip, from));
}

void MeasuringMachine::mechanism_changed(const sdk::DeviceObject* device, bool fresh) {
  device_ = device;
  finder_.restart();
  if (!fresh) return;
  settings_ = device != nullptr ? device->probing : sdk::Probing{};
  mode_ = ControlMode::AutomaticMove;
  supervisor_.probing().expect_hits_by_hand(false);
  last_hit_.reset();
  new_hit_ = false;
  spins_until_s_.reset();
}

bool MeasuringMachine::probe_active() const {
  if (device_ == nullptr) return false;
  return supervisor_.mechanism()->virtual_mode() || link_.status.read().probe.ready;
}

Expected<> MeasuringMachine::require_probe(const char* function) const {
  if (auto loaded = cam_.device().require(function); !loaded) return loaded;
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

Expected<> MeasuringMachine::auto_measure(std::int64_t id, const Vector& point, double speed) {
  constexpr const char* kFunction = "AutoMeasure";
  if (auto ready = require_settled_probe(kFunction); !ready) return ready;
  const auto from = queue_end();
  if (!from) return tl::unexpected(from.error());
  const Vector way = difference(point, from->tip);
  const double length = norm(way);
  if (!std::isfinite(length) || !(length > 1e-6)) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("{}: the tip stands at the point already, so there is no direction to search in; move "
                               "away from the surface first",
                               kFunction));
  }
  const Vector direction = scaled(1 / length, way);
  const double approach_mm = length - settings_.prehit_distance_mm;
  const auto target = [&](double mm) { return PathTargetGeometry{{along(from->tip, mm, direction), from->axis}}; };
  std::optional<Move> approach;
  if (approach_mm > 1e-6) {
    auto made = cam_.move_maker().path_move_at(kFunction, id, target(approach_mm), speed);
    if (!made) return tl::unexpected(made.error());
    approach = std::move(*made);
  }
  const auto search = cam_.move_maker().path_move_at(kFunction, id, target(length + settings_.search_distance_mm),
                                                     std::min(speed, settings_.scan_speed_mm_s));
  if (!search) return tl::unexpected(search.error());
  const Point before = std::exchange(point_, Point{id, from->tip, direction, speed, length, {}});
  auto queued = supervisor_.probing().add(approach, *search);
  if (!queued) point_ = before;
  return queued;
}

void MeasuringMachine::take(const HitFinder::Found& found) {
  last_hit_ = sdk::Hit{found.t_s, found.joints, tool_.at(found.joints)};
  new_hit_ = true;
  point_.hit = last_hit_;
}

void MeasuringMachine::assume_hit(const CycleSample& sample) {
  const Measurement::Phase phase = supervisor_.probing().phase();
  if (phase == Measurement::Phase::Standing) supervisor_.probing().simulate(false);
  if (phase != Measurement::Phase::Search || point_.hit) return;
  if (point_.way_to(sample.pose_set.tip) < point_.length_mm) return;
  take({sample.t_s, {sample.position_set.begin(), sample.position_set.begin() + sample.joint_count}});
  untold_.push_back(*last_hit_);
  supervisor_.probing().simulate(true);
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
  if (supervisor_.probing().phase() != Measurement::Phase::Standing || !point_.hit) return;
  const ToolPose stands = tool_.in_part();
  // From the hit, but never further than where the approach began: what lies behind is not known.
  const double hit_mm = point_.way_to(point_.hit->pose.tip);
  const double back_to_mm = std::max(hit_mm - settings_.retract_distance_mm, 0.0);
  const double here_mm = point_.way_to(stands.tip);
  const PathTargetGeometry target{{along(stands.tip, back_to_mm - here_mm, point_.direction), stands.axis}};
  // A refusal passes: the machine is still coming to rest, or its drives are.
  (void)cam_.move_maker().path_move_at("AutoMeasure", point_.id, target, point_.speed).and_then([&](const Move& move) {
    return supervisor_.probing().add_retract(move);
  });
}

Expected<> MeasuringMachine::manual_measure() {
  return require_probe("ManualMeasure").map([&] {
    mode_ = ControlMode::Manual;
    supervisor_.probing().expect_hits_by_hand(true);
  });
}

Expected<> MeasuringMachine::spin_probe(double rpm, double seconds) {
  constexpr const char* kFunction = "SpinProbe";
  if (auto found = cam_.device().find_spindle(0, kFunction); !found) return tl::unexpected(found.error());
  if (!std::isfinite(seconds) || !(seconds > 0)) {
    return failure(MinorCode::InvalidParameterValue, fmt::format("{}: {} s must be above 0", kFunction, seconds));
  }
  return supervisor_.require_rest(kFunction).and_then([&] { return cam_.spindles().set_rpm(0, rpm); }).map([&] {
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
  supervisor_.probing().simulate(touching);
  return {};
}

Expected<> MeasuringMachine::set_calibrated_part_frame() {
  constexpr const char* kFunction = "SetCalibratedPartFrame";
  if (auto loaded = cam_.device().require(kFunction); !loaded) return loaded;
  return supervisor_.require_rest(kFunction).and_then([&] {
    const ToolPose here = tool_.in_machine();
    return cam_.frames().set_part(frame_from_axis(here.tip, here.axis));
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
  return supervisor_.probing().phase() == Measurement::Phase::None ? mode_ : ControlMode::AutomaticMeasure;
}

Expected<> MeasuringMachine::set_control_mode(ControlMode mode) {
  constexpr const char* kFunction = "ControlMode";
  if (auto rest = supervisor_.require_rest(kFunction); !rest) return rest;
  if (mode == ControlMode::Manual) {
    if (mode_ != ControlMode::Inactive && mode_ != ControlMode::Shutdown) return manual_measure();
  }
  if (auto loaded = cam_.device().require(kFunction); !loaded) return loaded;
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
  supervisor_.probing().expect_hits_by_hand(mode_ == ControlMode::Manual);
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
