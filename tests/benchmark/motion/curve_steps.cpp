#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

#include "curves/make_curves.hpp"
#include "exact_nurbs.hpp"
#include "rows.hpp"
#include "shapes.hpp"

namespace rmac::bench {
namespace {

constexpr double kStep_mm = 0.1;  // 100 mm/s at 1 ms

/// Keeps the medians that Google Benchmark computes, and prints nothing.
class Medians final : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.aggregate_name == "median") median_us = run.GetAdjustedCPUTime();
    }
  }
  double median_us = NAN;
};

double time_a_step_us(const Curve& curve, int order) {
  const std::string name = "step" + std::to_string(order);
  benchmark::RegisterBenchmark(name.c_str(),
                               [&curve, order](benchmark::State& state) {
                                 CurvePoint point;
                                 double s = 0;
                                 for (auto _ : state) {
                                   curve.evaluate(s, order, 1, point);
                                   benchmark::DoNotOptimize(point);
                                   s += kStep_mm;
                                   if (s > curve.length()) s = 0;
                                 }
                               })
      ->Repetitions(25)
      ->MinTime(0.02)
      ->ReportAggregatesOnly()
      ->Unit(benchmark::kMicrosecond);
  Medians medians;
  benchmark::RunSpecifiedBenchmarks(&medians, "^" + name + "/");
  return medians.median_us;
}

}  // namespace

void curve_step_rows(Figures& figures, const Extent&) {
  const Nurbs nurbs = interpolated(butterfly, 2 * std::numbers::pi, 3, 90);
  Move move;
  move.feed_mm_s = 100;
  move.geometry = NurbsGeometry{NurbsSpace::Tip, nurbs};
  const auto& first = nurbs.points.front();
  const std::vector<double> joints(3, 0.0);
  const auto curves = make_curves(move, {{{first[0], first[1], first[2]}, kUp}, joints});
  if (!curves || curves->size() != 1) {
    figures.missing("butterfly_fluctuation", "<= 1e-06", "%", curves ? "cut into several" : curves.error().message);
    return;
  }
  const Curve& curve = *curves->front();
  const ExactNurbs exact(nurbs);
  double worst = 0, off_nm = 0;
  Real before = exact.begin();
  CurvePoint point;
  const auto steps = static_cast<int>(curve.length() / kStep_mm);
  for (int i = 1; i <= steps; ++i) {
    curve.evaluate(i * kStep_mm, 0, 1, point);
    const Real here = exact.nearest(point.d[0].data(), before + static_cast<Real>(kStep_mm) / exact.speed(before));
    worst =
        std::max(worst, std::abs(static_cast<double>(exact.length(before, here) / static_cast<Real>(kStep_mm) - 1)));
    off_nm = std::max(off_nm, 1e6 * static_cast<double>(exact.distance(point.d[0].data(), here)));
    before = here;
  }
  const Real whole = exact.length(exact.begin(), exact.end());
  figures.at_most("butterfly_fluctuation", 100 * worst, 1e-6, "%", std::to_string(steps) + " steps of 0.1 mm");
  figures.at_most("butterfly_length_error", std::abs(static_cast<double>(curve.length() / whole - 1)), 1e-9,
                  "of length");
  figures.at_most("butterfly_off_curve", off_nm, 1, "nm");
  int argc = 1;
  char name[] = "bench_motion";
  char* argv[] = {name, nullptr};
  benchmark::Initialize(&argc, argv);
  figures.at_most("butterfly_step_position", time_a_step_us(curve, 0), 0.5, "us", "median of 25, CPU time");
  figures.at_most("butterfly_step_setpoint", time_a_step_us(curve, 2), 0.5, "us",
                  "with speed and acceleration; median of 25");
}

}  // namespace rmac::bench
