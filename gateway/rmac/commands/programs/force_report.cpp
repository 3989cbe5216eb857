#include "gateway/rmac/commands/programs/force_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "gateway/json/printable.hpp"
#include "gateway/rmac/terminal/table.hpp"

namespace rmac::cli {
namespace {

using Json = nlohmann::json;

struct Quantity {
  const char* name;
  const char* unit;
};

Quantity quantity(gateway::Overload::Of of) {
  return of == gateway::Overload::Of::Torque ? Quantity{"torque", "N·m"} : Quantity{"power", "W"};
}

Json share_json(const gateway::CuttingShare& share) {
  return {{"cutting_s", share.time_s},       {"mean_force_n", share.mean_n},    {"peak_force_n", share.peak_n},
          {"mean_torque_nm", share.mean_nm}, {"peak_torque_nm", share.peak_nm}, {"mean_power_w", share.mean_w},
          {"peak_power_w", share.peak_w}};
}

bool asked_for(const CollisionWatch* watch) {
  return watch != nullptr && (watch->load() != nullptr || !watch->forces_not_told().empty());
}

}  // namespace

Json to_json(const std::vector<gateway::Overload>& overloads) {
  Json list = Json::array();
  for (const gateway::Overload& each : overloads) {
    list.push_back({{"what", quantity(each.of).name},
                    {"line", each.line},
                    {"move_id", each.move_id},
                    {"t_s", each.t_s},
                    {"until_s", each.until_s},
                    {"place_mm", {each.place[0], each.place[1], each.place[2]}},
                    {"most", each.most},
                    {"allowed", each.allowed}});
  }
  return list;
}

Json forces_json(const CollisionWatch* watch, bool by_move) {
  if (!asked_for(watch)) return "not told";
  Json object{{"not_told", watch->forces_not_told()}};
  const gateway::CuttingLoad* const load = watch->load();
  if (load == nullptr) return object;
  object.update(share_json(load->all()));
  object["material"] = load->material().name;
  object["source"] = load->material().source;
  object["overloads"] = to_json(load->overloads());
  if (by_move) {
    Json moves = Json::array();
    for (const auto& [move_id, share] : load->moves()) {
      moves.push_back(share_json(share));
      moves.back()["move_id"] = move_id;
    }
    object["moves"] = std::move(moves);
  }
  return object;
}

void add_force_rows(const CollisionWatch* watch, std::vector<std::vector<std::string>>& rows) {
  if (!asked_for(watch)) {
    rows.push_back({"cutting forces", "not told", "name a --setup with Stock and Material"});
    return;
  }
  const gateway::CuttingLoad* const load = watch->load();
  if (load == nullptr) {
    rows.push_back({"cutting forces", "NOT TOLD", ""});
    return;
  }
  const gateway::CuttingShare& all = load->all();
  if (all.time_s > 0) {
    rows.push_back({"force", number(all.peak_n),
                    fmt::format("N at most, {:.3g} in the mean of {:.3g} s in {}", all.mean_n, all.time_s,
                                load->material().name)});
    rows.push_back({"torque", number(all.peak_nm), fmt::format("N·m at most, {:.3g} in the mean", all.mean_nm)});
    rows.push_back({"power", number(all.peak_w), fmt::format("W at most, {:.3g} in the mean", all.mean_w)});
  }
  if (!watch->forces_not_told().empty()) {
    rows.push_back({"cutting forces", "NOT ALL TOLD", ""});
  } else if (all.time_s == 0) {
    rows.push_back({"cutting forces", "none", "nothing was cut"});
  }
}

void print_forces(const CollisionWatch& watch) {
  const gateway::CuttingLoad* const load = watch.load();
  if (load != nullptr && !load->overloads().empty()) {
    std::vector<std::vector<std::string>> rows;
    for (const gateway::Overload& each : load->overloads()) {
      rows.push_back({fmt::format("OVERLOAD: {}", quantity(each.of).name), std::to_string(each.line),
                      std::to_string(each.move_id), number(each.t_s), number(each.until_s), number(each.most),
                      number(each.allowed), quantity(each.of).unit,
                      fmt::format("{:.2f} {:.2f} {:.2f}", each.place[0], each.place[1], each.place[2])});
    }
    fmt::print("{}\n", table({"what", "line", "move", "from s", "to s", "takes", "spindle has", "", "at, mm"}, rows));
  }
  for (const std::string& what : watch.forces_not_told()) fmt::print("NOT TOLD: {}\n\n", gateway::printable(what));
}

Result<> force_verdict(const CollisionWatch& watch) {
  std::vector<std::string> clauses;
  if (const gateway::CuttingLoad* const load = watch.load(); load != nullptr && !load->overloads().empty()) {
    const gateway::Overload& first = load->overloads().front();
    clauses.push_back(
        fmt::format("{} times cutting takes more than the spindle has, first in line {}: {:.3g} of {:.3g} {}",
                    load->overloads().size(), first.line, first.most, first.allowed, quantity(first.of).unit));
  }
  const auto not_told = watch.forces_not_told();
  clauses.insert(clauses.end(), not_told.begin(), not_told.end());
  return clauses.empty() ? Result<>() : fail(fmt::format("{}", fmt::join(clauses, "; ")));
}

}  // namespace rmac::cli
