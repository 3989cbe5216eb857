#include "gateway/reconfiguration/learning.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "gateway/device_database/device_json.hpp"
#include "gateway/files/content_hash.hpp"
#include "gateway/json/printable.hpp"
#include "gateway/learning/learned_json.hpp"

namespace rmac::gateway {
namespace {

constexpr const char* kSet = "SetLearnedOffsets";

auto refuse(const std::string& why) {
  return failure(MinorCode::InvalidParameterValue, fmt::format("{}: {}", kSet, why));
}

}  // namespace

std::string Learning::configuration() const {
  ContentHash hash;
  hash.add(to_device_json(slot_.in_force()->device).dump());
  return hash.text();
}

Expected<> Learning::check_joints(const LearnedPath& path) const {
  const ServoLoop& loop = *slot_.in_force()->loop;
  if (path.joints() != loop.joint_count()) {
    return refuse(fmt::format("offsets of {} joints, and the machine moves {}", path.joints(), loop.joint_count()));
  }
  for (std::size_t j = 0; j < path.joints(); ++j) {
    const double bound = loop.learned_bound(j);
    if (path.largest(j) <= bound) continue;
    const std::string& name = joint_at(slot_.in_force()->device, j).limits.name;
    if (bound == 0) return refuse(fmt::format("joint {} takes no offset: its drive closes its loop itself", name));
    return refuse(
        fmt::format("joint {} would be moved by {:.6g}; a quarter of its MaxFollowingError, {:.6g}, is the "
                    "most",
                    name, path.largest(j), bound));
  }
  return {};
}

Expected<std::shared_ptr<const LearnedPath>> Learning::read(const nlohmann::json& object) const {
  auto learned = read_learned(object);
  if (!learned) return refuse(learned.error().message);
  const std::string& name = slot_.in_force()->device.name;
  if (learned->machine != name) {
    return refuse(fmt::format("it was learned with {}, and {} is loaded", printable(learned->machine), name));
  }
  if (learned->configuration != configuration()) {
    return refuse(
        fmt::format("it was learned with another configuration of {} (gains, filters, limits, …); learn the "
                    "program anew",
                    name));
  }
  auto path = LearnedPath::create(std::move(learned->path));
  if (!path) return refuse(path.error().message);
  if (auto fits = check_joints(*path); !fits) return tl::unexpected(fits.error());
  return std::make_shared<const LearnedPath>(std::move(*path));
}

Expected<> Learning::set_learned(const nlohmann::json& learned) {
  if (!slot_.in_force()) return refuse("no machine is loaded");
  if (auto rest = slot_.require_rest(kSet); !rest) return rest;
  if (!learned.is_null() && slot_.in_force()->virtual_mode())
    return refuse("in virtual mode no drive runs, and there is nothing to learn");
  SwapRequest request;
  request.learns = true;
  std::size_t moves = 0, knots = 0;
  if (!learned.is_null()) {
    auto path = read(learned);
    if (!path) return tl::unexpected(path.error());
    moves = (*path)->moves();
    knots = (*path)->knots();
    request.learned = std::move(*path);
  }
  if (auto asked = servo_.ask(request); !asked) return asked;
  moves_ = moves;
  knots_ = knots;
  supervisor_.wish([knots](ServoWishes& wishes) { wishes.learned = knots > 0; });
  return {};
}

Expected<nlohmann::json> Learning::learned() const {
  if (!slot_.in_force()) return failure(MinorCode::Other, "GetLearnedOffsets: no machine is loaded");
  const Mechanism& mechanism = *slot_.in_force();
  nlohmann::json joints = nlohmann::json::array();
  for (std::size_t j = 0; j < mechanism.loop->joint_count(); ++j) {
    joints.push_back({{"Name", joint_at(mechanism.device, j).limits.name},
                      {"LargestOffset", mechanism.loop->learned_bound(j)},
                      {"AnswerDelay", mechanism.loop->answer_delay(j)}});
  }
  return nlohmann::json{{"Machine", mechanism.device.name},
                        {"Configuration", configuration()},
                        {"Virtual", mechanism.virtual_mode()},
                        {"Period", mechanism.loop->parts().period_s},
                        {"Joints", std::move(joints)},
                        {"Moves", moves_.load()},
                        {"Knots", knots_.load()}};
}

void Learning::forget() {
  if (knots_.exchange(0) == 0) return;
  moves_ = 0;
  supervisor_.wish([](ServoWishes& wishes) { wishes.learned = false; });
}

}  // namespace rmac::gateway
