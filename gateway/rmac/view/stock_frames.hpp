#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "gateway/bodies/triangle_mesh.hpp"
#include "gateway/material/dexel_grid.hpp"
#include "gateway/material/material.hpp"

namespace rmac::cli {

/// What is left of a stock at some times while it is cut, coarse: so many that a page holds them, whatever the length
/// of the program.
class StockFrames {
 public:
  static constexpr std::size_t kMost = 16, kMostTriangles = 12'000;

  /// Of the material as it is; nothing where that was looked at not long ago, or nothing was cut since.
  void look(double t_s, const gateway::Material& material);
  /// A list of `t`, `points`, `triangles` (part frame), and `apart_mm`, of the points at most.
  [[nodiscard]] nlohmann::json to_json() const;

 private:
  struct Frame {
    double t_s = 0, apart_mm = 0;
    gateway::TriangleMesh mesh;
  };
  static constexpr double kFirstEvery_s = 0.5;

  std::vector<Frame> frames_;
  double every_s_ = kFirstEvery_s;
  double removed_mm3_ = 0;  ///< at the last look
  std::uint32_t nth_ = 0;   ///< of the rays; 0: not known yet
};

/// The surface of a stock, part frame, with no more triangles than these.
[[nodiscard]] nlohmann::json drawn_stock(const gateway::DexelGrid& grid, std::size_t most_triangles);

}  // namespace rmac::cli
