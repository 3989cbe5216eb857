#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "gateway/collision/checker.hpp"
#include "gateway/cutting/cutting_load.hpp"
#include "gateway/material/material.hpp"
#include "gateway/material/stock.hpp"
#include "gateway/rmac/wire/failure.hpp"
#include "gateway/simulation/simulation.hpp"
#include "rmac/motion/move.hpp"

namespace rmac::cli {

/// Watches a simulated machine for collisions with itself and with a set-up.
class CollisionWatch {
 public:
  struct Options {
    std::filesystem::path setup_file;       ///< which errors name
    std::optional<double> resolution_mm{};  ///< of the material, instead of the set-up's
    std::filesystem::path materials;        ///< the file of the work materials that are known
  };

  /// `machine` as for `Simulation::open`. Refused, with one line, where not all of it can be checked.
  [[nodiscard]] static Result<std::unique_ptr<CollisionWatch>> open(const std::string& machine,
                                                                    const std::filesystem::path& device_tree,
                                                                    gateway::Setup setup, const Options& options);

  /// Sets the part frame as somebody would who clamped the part there; a program may set another one.
  [[nodiscard]] Result<> place_part(gateway::Simulation& simulation) const;
  /// A move has been added to those that are not done; the first of them is done.
  void queued(const Move& move) { queue_.push_back({move.id, may_cut(move), leads_somewhere(move)}); }
  void move_done();
  /// The tool in the spindle, its number and what the table says of it, may be another.
  void tool_may_have_changed() noexcept { look_at_tool_ = true; }
  /// `bend_mm`: by so much the tool's tip is beside where the joints have it, part frame.
  void cycle(const gateway::CycleSample& sample, int line, gateway::Controller& controller,
             const Eigen::Vector3d& bend_mm = Eigen::Vector3d::Zero());
  /// The run is over.
  void finish();

  [[nodiscard]] const gateway::FindingList& findings() const noexcept { return checker_->findings(); }
  /// What is left of the stock; null where the set-up has none.
  [[nodiscard]] const gateway::Material* material() const noexcept { return material_.get(); }
  /// What cutting takes; null where the set-up has no stock or does not say of which material, or that is not known.
  [[nodiscard]] const gateway::CuttingLoad* load() const noexcept { return load_.get(); }
  /// Joints come where axes and tool truly are, and not where they are told to be: what these still cut after a move
  /// has ended is that move's. The listener hears of the tool in material, where there is a load, and outlives this.
  void goes_by_axes(gateway::EngagedListener& listener) noexcept {
    by_axes_ = true;
    if (load_) load_->listen(listener);
  }
  /// What of it cannot be told, a sentence each; empty: all is, or nobody asked.
  [[nodiscard]] std::vector<std::string> forces_not_told() const;
  [[nodiscard]] const gateway::Setup& setup() const noexcept { return setup_; }
  /// What was not checked, a sentence each; empty: all was.
  [[nodiscard]] const std::set<std::string>& not_checked() const noexcept { return not_checked_; }

 private:
  CollisionWatch(std::filesystem::path file, gateway::Setup setup, std::unique_ptr<gateway::CollisionChecker> checker)
      : file_(std::move(file)), setup_(std::move(setup)), checker_(std::move(checker)) {}
  /// Positioning moves go through air; what is programmed as a path may cut.
  [[nodiscard]] static bool may_cut(const Move& move) noexcept;
  /// It is a move, and no calls in turn or a dwell.
  [[nodiscard]] static bool leads_somewhere(const Move& move) noexcept;
  [[nodiscard]] Result<> watch_load(const std::filesystem::path& materials);
  void take_tool(gateway::Controller& controller);
  [[nodiscard]] gateway::MoveNow planned_move(const gateway::CycleSample& sample, int line) const;
  /// What takes material, with axes that come after it: a cut goes on until they and the tool have come to rest from
  /// it, where it ended or straight out of there.
  [[nodiscard]] gateway::MoveNow cut_under_way(const gateway::CycleSample& sample, const gateway::MoveNow& planned);

  std::filesystem::path file_;  ///< of the set-up
  gateway::Setup setup_;
  std::unique_ptr<gateway::CollisionChecker> checker_;
  std::unique_ptr<gateway::Material> material_;  ///< its findings go to the checker's
  std::unique_ptr<gateway::CuttingLoad> load_;   ///< listens to the material
  std::string unknown_material_;                 ///< why there is no load
  struct Queued {
    std::int64_t id;
    bool cuts, leads;
  };
  std::deque<Queued> queue_;  ///< what is not done
  std::set<std::string> not_checked_;
  std::string tool_fault_;  ///< what cannot be checked with the tool in the spindle
  std::string too_thin_;    ///< what of it is not found in material
  struct LastCut {
    gateway::MoveNow move;
    double ended_s = -1;
    ToolPose ended_at{};  ///< as planned
  };
  LastCut last_cut_;
  bool by_axes_ = false;
  bool look_at_tool_ = true;
  bool begun_ = false;  ///< the first position is reached, or something cuts
};

/// `"collisions"` of --json: certain ones and possible ones, each with where and how deep; `near` gives near misses.
[[nodiscard]] nlohmann::json to_json(const std::vector<gateway::Finding>& findings, bool near);

}  // namespace rmac::cli
