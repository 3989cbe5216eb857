#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "gateway/forces/turn_forces.hpp"
#include "gateway/tools/tool_shape.hpp"

namespace rmac::gateway::test {

/// What a sum over many short straight pieces of edge at many angles of the tool says: force on the tool, N, and
/// torque, N·m, at each of them. It knows the tool by the circle and line of its profile alone.
struct BruteForce {
  std::vector<std::array<double, 4>> at;
  double tangential_mean = 0;

  [[nodiscard]] double mean(std::size_t which) const {
    double sum = 0;
    for (const auto& value : at) sum += value[which];
    return sum / static_cast<double>(at.size());
  }
  [[nodiscard]] double peak(std::size_t which) const {
    double peak = 0;
    for (const auto& value : at) {
      if (std::abs(value[which]) > std::abs(peak)) peak = value[which];
    }
    return peak;
  }
};

inline BruteForce brute_force(const ToolShape& tool, const ForceCoefficients& k, std::span<const EngagedSlice> slices,
                              const ToothFeed& feed, int angles, int pieces) {
  using std::numbers::pi;
  struct Point {
    double r, z;
  };
  // The profile of each slice as a chain of points.
  const double corner = tool.re, flat = tool.dc / 2 - tool.re;
  const auto corner_point = [&](double k_angle) {
    return Point{flat + corner * std::sin(k_angle), corner - corner * std::cos(k_angle)};
  };
  const auto angle_at = [&](double z) {
    return std::acos(std::clamp((corner - z) / std::max(corner, 1e-9), -1.0, 1.0));
  };
  struct Piece {
    double r, z, width, sin_k, cos_k, edge;
    const EngagedSlice* slice;
  };
  std::vector<Piece> edge;
  for (const EngagedSlice& slice : slices) {
    std::vector<Point> chain;
    if (slice.from_mm < corner) {
      const double low = angle_at(slice.from_mm), high = angle_at(std::min(slice.to_mm, corner));
      for (int i = 0; i <= pieces; ++i) chain.push_back(corner_point(low + (high - low) * i / pieces));
    }
    if (slice.to_mm > corner) {
      const double low = std::max(slice.from_mm, corner);
      for (int i = chain.empty() ? 0 : 1; i <= pieces; ++i) {
        chain.push_back({tool.dc / 2, low + (slice.to_mm - low) * i / pieces});
      }
    }
    for (std::size_t i = 1; i < chain.size(); ++i) {
      const double dr = chain[i].r - chain[i - 1].r, dz = chain[i].z - chain[i - 1].z, width = std::hypot(dr, dz);
      const double r = (chain[i].r + chain[i - 1].r) / 2;
      const double turn = dz * std::tan(tool.fha * pi / 180) / (tool.dc / 2);
      edge.push_back({r, (chain[i].z + chain[i - 1].z) / 2, width, dz / width, dr / width,
                      std::sqrt(dr * dr + dz * dz + r * turn * r * turn), &slice});
    }
  }
  BruteForce result;
  // A turn of one pitch brings each tooth to where the next one was.
  const int steps = angles / tool.zefp;
  for (int step = 0; step < steps; ++step) {
    std::array<double, 4> sum{};
    for (int tooth = 0; tooth < tool.zefp; ++tooth) {
      for (const Piece& piece : edge) {
        double phi = 2 * pi * ((step + 0.5) / steps + tooth) / tool.zefp -
                     piece.z * std::tan(tool.fha * pi / 180) / (tool.dc / 2);
        phi -= 2 * pi * std::floor(phi / (2 * pi));
        const bool in = std::ranges::any_of(piece.slice->arcs, [&](const Arc& arc) {
          return (phi >= arc.entry && phi <= arc.exit) || (phi + 2 * pi >= arc.entry && phi + 2 * pi <= arc.exit) ||
                 (phi - 2 * pi >= arc.entry && phi - 2 * pi <= arc.exit);
        });
        // Outwards from the tool, by which way the tool goes from tooth to tooth.
        const double out_x = std::sin(phi) * piece.sin_k, out_y = std::cos(phi) * piece.sin_k, out_z = -piece.cos_k;
        const double chip = out_x * feed.across_mm + out_z * feed.along_mm;
        if (!in || chip < 0) continue;
        const double ft = k.ktc * chip * piece.width + k.kte * piece.edge;
        const double fr = k.krc * chip * piece.width + k.kre * piece.edge;
        const double fa = k.kac * chip * piece.width + k.kae * piece.edge;
        // Against the motion of the tooth, against the outward normal, and down along the profile.
        const std::array<double, 3> back{-std::cos(phi), std::sin(phi), 0};
        const std::array<double, 3> down{-std::sin(phi) * piece.cos_k, -std::cos(phi) * piece.cos_k, -piece.sin_k};
        const std::array<double, 3> out{out_x, out_y, out_z};
        for (std::size_t i = 0; i < 3; ++i) sum[i] += ft * back[i] - fr * out[i] + fa * down[i];
        sum[3] += ft * piece.r / 1000;
        result.tangential_mean += ft / steps;
      }
    }
    result.at.push_back(sum);
  }
  return result;
}

}  // namespace rmac::gateway::test
