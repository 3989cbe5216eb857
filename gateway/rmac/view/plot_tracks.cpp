#include "gateway/rmac/view/plot_tracks.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "gateway/rmac/view/rounded.hpp"

namespace rmac::cli {

std::size_t PlotTracks::start(Kind kind) {
  const double tolerance = kind.tolerance;
  plots_.push_back({std::move(kind), ThinnedTrack<WaitingNumbers>(tolerance)});
  return plots_.size() - 1;
}

void PlotTracks::add(std::size_t plot, double t_s, double value) {
  Plotted& plotted = plots_[plot];
  plotted.any = plotted.any || value != 0;
  plotted.track.add(t_s, value);
  while (plotted.track.keys().size() > plotted.kind.most_keys) plotted.track.coarsen();
}

void PlotTracks::end() {
  for (Plotted& plotted : plots_) plotted.track.end();
}

nlohmann::json PlotTracks::to_json() const {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [kind, track, any] : plots_) {
    if (!any) continue;
    std::vector<double> times, values;
    for (const auto& [t_s, value] : track.keys()) times.push_back(t_s), values.push_back(value);
    nlohmann::json levels = nlohmann::json::array();
    for (const Level& level : kind.levels) levels.push_back({{"name", level.name}, {"is", level.is}});
    list.push_back({{"row", kind.row},
                    {"name", kind.name},
                    {"unit", kind.unit},
                    {"within", rounded(track.within(), kind.digits)},
                    {"levels", std::move(levels)},
                    {"t", rounded(times, kTimeDigits)},
                    {"is", rounded(values, kind.digits)}});
  }
  return list;
}

}  // namespace rmac::cli
