#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "clients/legacy/apt/statements/arguments.hpp"

namespace rmac::apt {

/// The axis system that coordinates are in. CAM systems write where it lies in theirs: NX in MSYS, CATIA in comments
/// behind `$$*CATIA0`, Creo behind `$$-> CSYS`. The first is the frame of the part; where another one would be, only
/// the CAM system's user knows.
class AxisSystems {
 public:
  /// MSYS/ nine numbers.
  void set(Arguments& arguments);
  void read_comment(const Statement& comment);
  /// Comments end where another statement stands.
  void end_comments() noexcept { rows_.reset(); }

 private:
  void require_first(const std::vector<double>& values, std::size_t place);

  std::vector<double> first_;
  std::optional<std::vector<double>> rows_;  ///< of the matrix in comments, as far as they were read
};

}  // namespace rmac::apt
