#include "gateway/learning/learned_json.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string_view>

namespace rmac::gateway {
namespace {

using Json = nlohmann::json;
using namespace std::string_view_literals;

constexpr std::array kMembers{"Machine"sv, "Configuration"sv, "Moves"sv, "End"sv, "Places"sv, "Joints"sv};

auto refuse(std::string why) {
  return failure(MinorCode::InvalidParameterValue, std::move(why));
}

Expected<> check_members(const Json& object) {
  if (!object.is_object()) return refuse("what was learned is one object");
  for (const auto name : kMembers) {
    if (!object.contains(name)) return refuse(fmt::format("/{} is missing", name));
  }
  if (object.size() != kMembers.size()) return refuse(fmt::format("there are {} members alone", kMembers.size()));
  for (const auto* name : {"Machine", "Configuration"}) {
    if (!object[name].is_string()) return refuse(fmt::format("/{} is no text", name));
  }
  for (const auto* name : {"Moves", "Places", "Joints"}) {
    if (!object[name].is_array()) return refuse(fmt::format("/{} is no list", name));
  }
  if (!object["End"].is_number()) return refuse("/End is no number");
  return {};
}

Expected<std::vector<double>> read_numbers(const Json& list, const std::string& name, std::size_t most) {
  if (!list.is_array()) return refuse(fmt::format("{} is no list", name));
  if (list.size() > most) return refuse(fmt::format("{} has {} numbers; {} are possible", name, list.size(), most));
  std::vector<double> numbers;
  numbers.reserve(list.size());
  for (const Json& value : list) {
    if (!value.is_number() || !std::isfinite(value.get<double>())) {
      return refuse(fmt::format("{}[{}] is no number", name, numbers.size()));
    }
    numbers.push_back(value.get<double>());
  }
  return numbers;
}

Expected<> read_moves(const Json& list, std::vector<LearnedPath::Move>& moves) {
  if (list.size() > LearnedPath::kMostKnots) {
    return refuse(fmt::format("/Moves has {} moves; {} are possible", list.size(), LearnedPath::kMostKnots));
  }
  for (const Json& move : list) {
    if (!move.is_array() || move.size() != 2 || !move[0].is_number_integer() || !move[1].is_number()) {
      return refuse(fmt::format("/Moves/{} is no MoveID with the place where it begins", moves.size()));
    }
    moves.push_back({move[0].get<std::int64_t>(), move[1].get<double>()});
  }
  return {};
}

Expected<> read_offsets(const Json& list, LearnedPath::Parts& path) {
  path.joints = list.size();
  if (path.joints > kMaxJoints) return refuse(fmt::format("/Joints has {} of them", path.joints));
  path.offsets.resize(path.places.size() * path.joints);
  for (std::size_t j = 0; j < path.joints; ++j) {
    const std::string name = fmt::format("/Joints/{}/Offsets", j);
    const auto offsets =
        read_numbers(list[j].is_object() ? list[j].value("Offsets", Json()) : Json(), name, LearnedPath::kMostKnots);
    if (!offsets) return tl::unexpected(offsets.error());
    if (offsets->size() != path.places.size()) {
      return refuse(fmt::format("{} has {} numbers for {} places", name, offsets->size(), path.places.size()));
    }
    for (std::size_t i = 0; i < offsets->size(); ++i) path.offsets[i * path.joints + j] = (*offsets)[i];
  }
  return {};
}

/// To 0.01 µm or 0.00001°, a thousandth of what a program can be learned to; towards 0, so that a bound is kept.
double rounded(double value) {
  return std::trunc(value * 1e5) / 1e5;
}

}  // namespace

Expected<Learned> read_learned(const Json& object) {
  if (auto fine = check_members(object); !fine) return tl::unexpected(fine.error());
  Learned learned{object["Machine"], object["Configuration"], {}};
  learned.path.end_mm = object["End"];
  auto places = read_numbers(object["Places"], "/Places", LearnedPath::kMostKnots);
  if (!places) return tl::unexpected(places.error());
  learned.path.places = std::move(*places);
  const auto rest = read_moves(object["Moves"], learned.path.moves).and_then([&] {
    return read_offsets(object["Joints"], learned.path);
  });
  if (!rest) return tl::unexpected(rest.error());
  return learned;
}

Json to_json(const Learned& learned) {
  const LearnedPath::Parts& path = learned.path;
  Json moves = Json::array(), joints = Json::array();
  for (const LearnedPath::Move& move : path.moves) moves.push_back({move.id, move.begin_mm});
  for (std::size_t j = 0; j < path.joints; ++j) {
    Json offsets = Json::array();
    for (std::size_t i = j; i < path.offsets.size(); i += path.joints) offsets.push_back(rounded(path.offsets[i]));
    joints.push_back({{"Offsets", std::move(offsets)}});
  }
  return {{"Machine", learned.machine}, {"Configuration", learned.configuration},
          {"Moves", std::move(moves)},  {"End", path.end_mm},
          {"Places", path.places},      {"Joints", std::move(joints)}};
}

}  // namespace rmac::gateway
