#include "tubes/tube_spline.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "curves/vector.hpp"
#include "splines/quintic.hpp"

namespace rmac {
namespace {

using curves::along;
using curves::cross;
using curves::difference;
using curves::dot;
using curves::scaled;
using curves::unit;
using quintic::Basis;
using quintic::kDegree;

constexpr int kSamplesASpan = 5;
/// How far along the path the spline may be from a vertex at its place, in widths: a vertex seen from too far aside is
/// seen from the wrong line.
constexpr double kVertexSlack = 5;
/// Control points that are given kept the tube of the fit before; its samples lay elsewhere.
constexpr double kGivenSlack = 1.01;

/// Lines' directions, and across each one the direction in which the polyline bends there and the third one.
struct LineFrame {
  Vector tangent, bend, side;
};

std::vector<LineFrame> frames_of(const Polyline& polyline) {
  const std::size_t lines = polyline.lines();
  std::vector<Vector> tangents;
  for (std::size_t k = 0; k < lines; ++k)
    tangents.push_back(unit(difference(polyline.vertices[k + 1], polyline.vertices[k])));
  std::vector<LineFrame> frames;
  for (std::size_t k = 0; k < lines; ++k) {
    const Vector& t = tangents[k];
    Vector bend = difference(tangents[std::min(k + 1, lines - 1)], tangents[k > 0 ? k - 1 : 0]);
    bend = along(bend, -dot(bend, t), t);
    if (dot(bend, bend) < 1e-12) {
      Vector least{};
      least[static_cast<std::size_t>(
          std::min_element(t.begin(), t.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }) -
          t.begin())] = 1;
      bend = along(least, -dot(least, t), t);
    }
    bend = unit(bend);
    frames.push_back({t, bend, cross(t, bend)});
  }
  return frames;
}

/// ∫ |S'''|².
std::vector<SplineDemand> demands_of_smoothness(const std::vector<double>& knots, std::size_t count) {
  std::vector<SplineDemand> demands;
  for (std::size_t i = kDegree; i < count; ++i) {
    const double width = knots[i + 1] - knots[i];
    for (const auto& [place, share] : quintic::kThirdDerivativeSquared) {
      const double w = 2 * width * share;
      demands.push_back({quintic::derivatives(knots, count, knots[i] + width * place, 3),
                         {Vector{w, 0, 0}, Vector{0, w, 0}, Vector{0, 0, w}}});
    }
  }
  return demands;
}

/// An octagon about the line; `scale` is one over its width.
TubeSample across(const Basis& basis, const Vector& point, const LineFrame& frame, double scale) {
  const double diagonal = scale * std::sqrt(0.5);
  TubeSample sample{basis, point, {}, 4};
  sample.bounds[0].direction = scaled(scale, frame.bend);
  sample.bounds[1].direction = scaled(scale, frame.side);
  sample.bounds[2].direction = along(scaled(diagonal, frame.bend), diagonal, frame.side);
  sample.bounds[3].direction = along(scaled(diagonal, frame.bend), -diagonal, frame.side);
  return sample;
}

}  // namespace

void lay_tube_samples(const std::vector<double>& knots, const Polyline& polyline, const std::vector<double>& widths,
                      std::size_t kept, TubeProgram& program) {
  const std::size_t count = knots.size() - kDegree - 1;
  const auto frames = frames_of(polyline);
  const std::size_t lines = polyline.lines();
  const auto scale = [&](const Basis& basis, std::size_t line) {
    return 1 / (widths[line] * (basis.first < kept ? kGivenSlack : 1));
  };
  std::size_t line = 0;
  for (std::size_t i = kDegree; i < count; ++i) {
    for (int part = 0; part < kSamplesASpan; ++part) {
      const double place = knots[i] + (knots[i + 1] - knots[i]) * part / kSamplesASpan;
      while (line + 1 < lines && polyline.places[line + 1] <= place) ++line;
      const Basis basis = quintic::basis(knots, count, place);
      program.add(across(basis, polyline.vertices[line], frames[line], scale(basis, line)));
    }
  }
  for (std::size_t k = 1; k < lines; ++k) {
    if (polyline.places[k] <= knots[kDegree]) continue;
    const Basis basis = quintic::basis(knots, count, polyline.places[k]);
    const Vector& vertex = polyline.vertices[k];
    for (const std::size_t side : {k - 1, k}) program.add(across(basis, vertex, frames[side], scale(basis, side)));
    const double shorter =
        std::min(polyline.places[k] - polyline.places[k - 1], polyline.places[k + 1] - polyline.places[k]);
    const double slack = std::min(kVertexSlack * widths[k], 0.2 * shorter);
    TubeSample sample{basis, vertex, {}, 1};
    sample.bounds[0].direction = scaled(1 / slack, unit(along(frames[k - 1].tangent, 1, frames[k].tangent)));
    program.add(sample);
  }
}

bool smoothest_in_tube(const std::vector<double>& knots, const Polyline& polyline, const std::vector<double>& widths_mm,
                       std::size_t kept, std::vector<Vector>& points) {
  points.resize(knots.size() - kDegree - 1);
  if (points.size() < kept + 2) return false;
  if (kept == 1) points.front() = polyline.vertices.front();
  points.back() = polyline.vertices.back();
  TubeProgram program(kept, points);
  lay_tube_samples(knots, polyline, widths_mm, kept, program);
  std::size_t work = 0;
  return program.solve(demands_of_smoothness(knots, points.size()), false, work);
}

}  // namespace rmac
