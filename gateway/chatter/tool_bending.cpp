#include "gateway/chatter/tool_bending.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace rmac::gateway {
namespace {

using std::numbers::pi;

constexpr double kFluteThickness = 0.8;  ///< of DC
constexpr int kElementsASection = 12;
constexpr Eigen::Index kModes = 3;
constexpr double kAssumedDamping = 0.02;
constexpr double kShortest_mm = 1e-3;

/// N, mm, s and tonnes.
struct Material {
  double young_n_mm2 = 0, density_t_mm3 = 0, poisson = 0;
};

/// Of a fine-grained cemented carbide with 10 % of cobalt, and of a molybdenum high-speed steel.
Material material_of(BodyMaterial body) {
  return body == BodyMaterial::Carbide ? Material{580e3, 14.45e-9, 0.22} : Material{220e3, 8.1e-9, 0.29};
}

/// What sticks out of the holder, from there to the tip, in short cylinders.
struct Cylinder {
  double length_mm = 0, radius_mm = 0;
};

std::vector<Cylinder> cylinders_of(const ToolShape& shape, double sticks_out_mm) {
  std::vector<Cylinder> from_tip;
  const auto add = [&](const ConeShape& section, double begins_mm) {
    const double height = std::min(section.height, sticks_out_mm - begins_mm);
    if (height < kShortest_mm) return;
    for (int i = 0; i < kElementsASection; ++i) {
      const double middle = (i + 0.5) / kElementsASection * height / section.height;
      from_tip.push_back({height / kElementsASection, std::lerp(section.bottom_radius, section.top_radius, middle)});
    }
  };
  const double flutes = kFluteThickness * shape.dc / 2;
  add({flutes, flutes, shape.lcf}, 0);
  double begins_mm = shape.lcf;
  for (const ConeShape& section : shape.shank) {
    add(section, begins_mm);
    begins_mm += section.height;
  }
  std::ranges::reverse(from_tip);
  return from_tip;
}

/// Stiffness and mass of the beam, of place and slope at each node but the clamped one (J. S. Przemieniecki, Theory of
/// matrix structural analysis, secs. 5.6 and 11.6; of the mass, that of a slender beam, and its sections' turning).
struct Beam {
  Eigen::MatrixXd stiffness, mass;
};

Beam beam_of(const std::vector<Cylinder>& cylinders, const Material& material) {
  const auto nodes = static_cast<Eigen::Index>(cylinders.size()) + 1;
  Beam beam{Eigen::MatrixXd::Zero(2 * nodes, 2 * nodes), Eigen::MatrixXd::Zero(2 * nodes, 2 * nodes)};
  for (Eigen::Index i = 0; i + 1 < nodes; ++i) {
    const auto& [l, r] = cylinders[static_cast<std::size_t>(i)];
    const double area = pi * r * r, inertia = pi * r * r * r * r / 4;
    const double shear_modulus = material.young_n_mm2 / (2 * (1 + material.poisson));
    const double shear_area = area * 6 * (1 + material.poisson) / (7 + 6 * material.poisson);  // of a round section
    const double shear = 12 * material.young_n_mm2 * inertia / (shear_modulus * shear_area * l * l);
    Eigen::Matrix4d k, m, turning;
    k << 12, 6 * l, -12, 6 * l,                                   //
        6 * l, (4 + shear) * l * l, -6 * l, (2 - shear) * l * l,  //
        -12, -6 * l, 12, -6 * l,                                  //
        6 * l, (2 - shear) * l * l, -6 * l, (4 + shear) * l * l;
    m << 156, 22 * l, 54, -13 * l,              //
        22 * l, 4 * l * l, 13 * l, -3 * l * l,  //
        54, 13 * l, 156, -22 * l,               //
        -13 * l, -3 * l * l, -22 * l, 4 * l * l;
    turning << 36, 3 * l, -36, 3 * l,      //
        3 * l, 4 * l * l, -3 * l, -l * l,  //
        -36, -3 * l, 36, -3 * l,           //
        3 * l, -l * l, -3 * l, 4 * l * l;
    k *= material.young_n_mm2 * inertia / ((1 + shear) * l * l * l);
    m = material.density_t_mm3 * (area * l / 420 * m + inertia / (30 * l) * turning);
    beam.stiffness.block<4, 4>(2 * i, 2 * i) += k;
    beam.mass.block<4, 4>(2 * i, 2 * i) += m;
  }
  const Eigen::Index free = 2 * nodes - 2;
  return {beam.stiffness.bottomRightCorner(free, free), beam.mass.bottomRightCorner(free, free)};
}

ToolBending of_beam(const Beam& beam) {
  const Eigen::Index tip = beam.stiffness.rows() - 2;
  const Eigen::VectorXd unit = Eigen::VectorXd::Unit(beam.stiffness.rows(), tip);
  ToolBending bending{.compliance_mm_n = beam.stiffness.llt().solve(unit)[tip], .modes = {}};
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solved(beam.stiffness, beam.mass);
  for (Eigen::Index i = 0; i < std::min(kModes, solved.eigenvalues().size()); ++i) {
    const double omega2 = solved.eigenvalues()[i], at_tip = solved.eigenvectors()(tip, i);
    bending.modes.push_back({.frequency_hz = std::sqrt(omega2) / (2 * pi),
                             .damping_ratio = kAssumedDamping,
                             .stiffness_n_mm = omega2 / (at_tip * at_tip)});
  }
  return bending;
}

}  // namespace

Expected<ToolBending> bending_of(const Tool& tool) {
  if (!tool.shape) return failure(MinorCode::InvalidParameterValue, "it has no Shape in the tool table");
  const ToolShape& shape = *tool.shape;
  if (!shape.modes.empty()) {
    ToolBending bending{.compliance_mm_n = 0, .modes = shape.modes};
    for (const TipMode& mode : shape.modes) bending.compliance_mm_n += 1 / mode.stiffness_n_mm;
    return bending;
  }
  if (shape.bmc == BodyMaterial::Unknown) {
    return failure(MinorCode::InvalidParameterValue,
                   "its Shape does not say how it gives way; give BMC in the tool table, or the Modes of its tip");
  }
  const auto cylinders = cylinders_of(shape, shape.holder_begins(tool.length_mm));
  if (cylinders.empty()) {
    return failure(MinorCode::InvalidParameterValue, "nothing of it sticks out of its holder by its Shape");
  }
  return of_beam(beam_of(cylinders, material_of(shape.bmc)));
}

}  // namespace rmac::gateway
