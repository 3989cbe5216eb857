#include "gateway/rmac/measuring/prober.hpp"

#include "gateway/rmac/wire/notes.hpp"
#include "gateway/rmac/wire/requests.hpp"
#include "gateway/rmac/wire/rest.hpp"

namespace rmac::cli {

using nlohmann::json;

Prober::Prober(Connection& connection, const ProbeWays& ways) : connection_(connection), ways_(ways) {
  connection_.on_notification([this](const std::string& topic, const json& note) { take(topic, note); });
}

Prober::~Prober() {
  connection_.on_notification({});
}

Result<> Prober::begin() {
  if (auto heard = subscribe(connection_, kEventsTopic); !heard) return heard;
  if (auto started = start_cycle(connection_); !started) return started;
  const auto state = wait_for_rest(connection_, failure_);
  if (!state) return tl::unexpected(state.error());
  at_ = {state->pose[0], state->pose[1], state->pose[2]};
  return {};
}

Result<Vector> Prober::touch(const Vector& tip, const Vector& normal) {
  Vector over = tip;
  for (std::size_t i = 0; i < 3; ++i) over[i] += ways_.clearance_mm * normal[i];
  const double height = ways_.safe_height_mm;
  for (const Vector& way : {Vector{at_[0], at_[1], height}, Vector{over[0], over[1], height}, over}) {
    if (auto gone = move(kMoveToPoint, way); !gone) return tl::unexpected(gone.error());
  }
  hit_.reset();
  if (auto touched = move(kMeasurePoint, tip); !touched) return tl::unexpected(touched.error());
  at_ = over;
  if (hit_) return *hit_;
  return fail("a point was measured, and no hit was told");
}

Result<> Prober::leave() {
  return move(kMoveToPoint, {at_[0], at_[1], ways_.safe_height_mm});
}

Result<> Prober::move(const char* method, const Vector& to) {
  done_ = false;
  ++move_id_;
  const auto queued = connection_.command(
      method, {{"MoveID", move_id_}, {"x", to[0]}, {"y", to[1]}, {"z", to[2]}, {"Speed", ways_.speed_mm_s}});
  if (!queued) return queued;
  auto waited = connection_.wait([this] { return done_ || !failure_.empty(); });
  if (!waited) return waited;
  return failure_.empty() ? Result<>() : fail(failure_);
}

void Prober::take(const std::string& topic, const json& note) {
  using Kind = gateway::Event::Kind;
  if (topic != kEventsTopic) return;
  const EventNote event = read_event(note);
  if (event.is(Kind::MoveDone) && event.move_id == move_id_) done_ = true;
  if (event.is(Kind::Fault) || event.is(Kind::Stopped)) failure_ = event.message;
  if (event.is(Kind::Hit) && note.contains("pose")) {
    hit_ = Vector{note["pose"][0].get<double>(), note["pose"][1].get<double>(), note["pose"][2].get<double>()};
  }
}

}  // namespace rmac::cli
