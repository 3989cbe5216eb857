#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "gateway/rmac/view/thinned_track.hpp"

namespace rmac::cli {

/// What the page plots over time: of each plot those keys that are needed.
class PlotTracks {
 public:
  static constexpr std::size_t kMostKeys = 100'000;

  /// A value that a plot is held against.
  struct Level {
    std::string name;
    double is = 0;
  };
  struct Kind {
    std::string row;  ///< plots of one row and one unit are drawn in one
    std::string name;
    std::string unit;
    double tolerance = 0;
    int digits = 0;  ///< behind the point
    std::vector<Level> levels{};
    std::size_t most_keys = kMostKeys;  ///< beyond them it is coarser
  };

  /// One more plot; its number.
  std::size_t start(Kind kind);
  /// Times of a plot ascend.
  void add(std::size_t plot, double t_s, double value);
  /// Nothing is added behind it.
  void end();

  /// Those that were not 0 all the time.
  [[nodiscard]] nlohmann::json to_json() const;

 private:
  struct Plotted {
    Kind kind;
    ThinnedTrack<WaitingNumbers> track;
    bool any = false;  ///< it was not 0 all the time
  };
  std::vector<Plotted> plots_;
};

}  // namespace rmac::cli
