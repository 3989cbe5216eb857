#pragma once

#include <cstddef>
#include <filesystem>

namespace rmac::gateway {

struct FlightRecorderOptions {
  std::filesystem::path folder{};  ///< empty: no records
  double seconds = 10;             ///< before what happened; 0: no records
  std::size_t files_kept = 20;     ///< for each cause; the oldest make way

  [[nodiscard]] bool wanted() const noexcept { return !folder.empty() && seconds > 0; }
};

}  // namespace rmac::gateway
