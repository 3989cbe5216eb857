#include <malloc.h>

#include <string>

#include "drive.hpp"
#include "machines.hpp"
#include "rows.hpp"
#include "shapes.hpp"

namespace rmac::bench {
namespace {

Move line(const Vector& from, const Vector& to, std::int64_t id) {
  Move move;
  move.id = id;
  move.feed_mm_s = 100;
  move.tolerance_mm = 0.01;
  move.geometry = LineGeometry{{from, kUp}, {to, kUp}};
  return move;
}

}  // namespace

/// Lines of 0.2 mm along roses, one after the other, the queue kept full: CPU time of building, queueing and planning.
void planning_rows(Figures& figures, const Extent& extent) {
  const auto corners = polyline(rose, 2 * std::acos(-1.0), 0.2);
  const std::size_t round = corners.size() - 1;
  const auto corner = [&](std::size_t i) { return corners[i % round]; };
  const PlannerModel model = bench_xyz(2000, 50000);
  const std::size_t most = static_cast<std::size_t>(extent.cases(200'000, 15'000));
  Drive drive(model, {corner(0)[0], corner(0)[1], corner(0)[2]});
  std::size_t sent = 0;
  std::vector<double> append_us;
  double building_s = 0;
  const auto append = [&] {
    const Move move = line(corner(sent), corner(sent + 1), static_cast<std::int64_t>(sent) + 1);
    const CpuTime time;
    const auto queued = drive.queue(move);
    const double took = time.since_s();
    if (!queued) return false;
    building_s += took;
    if (sent >= Planner::kQueueCapacity) append_us.push_back(1e6 * took);
    ++sent;
    return true;
  };
  const std::size_t before = mallinfo2().uordblks;
  while (sent < Planner::kQueueCapacity && append()) {
  }
  const double queued_mb = 1e-6 * static_cast<double>(mallinfo2().uordblks - before);
  drive.planner.command(PathCommand::Run);
  const double longest_s = 60;  // of planning: a planner too slow for this row shall not hold up the others
  while (sent < most && drive.planning_s() < longest_s) {
    drive.cycle();
    while (drive.planner.moves_left() < Planner::kQueueCapacity && sent < most && append()) {
    }
  }
  const std::size_t done = sent - drive.planner.moves_left();
  const double busy_s = drive.planning_s() + building_s * static_cast<double>(done) / static_cast<double>(sent);
  const std::string note = std::to_string(done) + " lines planned";
  figures.at_least("planning_rate", static_cast<double>(done) / busy_s, 100'000, "lines/s", note + ", CPU time");
  figures.at_most("append_p99", quantile(append_us, 0.99), 20, "us",
                  std::to_string(append_us.size()) + " with 10000 queued, CPU time");
  figures.inform("queue_memory", queued_mb, "MB", "10000 lines queued, the most there can be");
  figures.inform("append_p50", quantile(append_us, 0.5), "us");
}

}  // namespace rmac::bench
