#include "gateway/rmac/commands/programs/collision_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "gateway/json/printable.hpp"
#include "gateway/rmac/terminal/table.hpp"

namespace rmac::cli {
namespace {

struct Counts {
  std::size_t certain = 0, possible = 0, near = 0;
};

Counts counts(const CollisionWatch& watch) {
  Counts found;
  for (const gateway::Finding& f : watch.findings().sorted()) {
    ++(!f.collision ? found.near : f.possible ? found.possible : found.certain);
  }
  return found;
}

}  // namespace

std::string summary(const CollisionWatch& watch) {
  const Counts found = counts(watch);
  std::string text = found.certain + found.possible == 0 ? "none" : fmt::format("{}", found.certain);
  if (found.possible > 0) text += fmt::format(", and {} possible", found.possible);
  if (!watch.not_checked().empty()) text += ", NOT ALL CHECKED";
  return text;
}

void print_collisions(const CollisionWatch& watch) {
  std::vector<std::vector<std::string>> rows;
  for (const gateway::Finding& f : watch.findings().sorted()) {
    rows.push_back({!f.collision ? "near miss"
                    : f.possible ? "possible"
                                 : "COLLISION",
                    std::to_string(f.line), std::to_string(f.move_id), number(f.t_s), f.first, f.second,
                    f.collision ? number(f.depth_mm) + " deep" : number(f.distance_mm) + " apart",
                    fmt::format("{:.2f} {:.2f} {:.2f}", f.place[0], f.place[1], f.place[2])});
  }
  if (!rows.empty()) {
    fmt::print("{}\n",
               table({"what", "line", "move", "at s", "body", "body", "mm", "place in the part frame, mm"}, rows));
  }
  if (watch.findings().left_off() > 0) fmt::print("… and more, which are not listed\n\n");
  for (const std::string& what : watch.not_checked()) fmt::print("NOT CHECKED: {}\n\n", gateway::printable(what));
}

void add_collisions(const CollisionWatch& watch, nlohmann::json& report) {
  report["collisions"] = to_json(watch.findings().sorted(), false);
  report["near_misses"] = to_json(watch.findings().sorted(), true);
  report["collisions_not_checked"] = watch.not_checked();
  report["findings_left_off"] = watch.findings().left_off() > 0;
}

}  // namespace rmac::cli
