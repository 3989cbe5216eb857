#pragma once

#include <deque>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "gateway/bodies/link_chain.hpp"
#include "gateway/collision/finding_list.hpp"
#include "gateway/material/cut_listener.hpp"
#include "gateway/material/dexel_grid.hpp"
#include "gateway/material/removal.hpp"
#include "gateway/material/removed_volume.hpp"
#include "gateway/material/sweep/stroke_maker.hpp"
#include "gateway/tools/tool.hpp"

namespace rmac::gateway {

/// What is left of the stock while the machine moves: the cutting part of the tool takes away what it passes while the
/// spindle turns, and what any other part of the tool meets, or the cutting part in a positioning move or with a
/// spindle that stands, is a finding.
class Material {
 public:
  /// `grid` holds the stock, in the part frame; findings go to the list, which outlives this.
  Material(LinkChain chain, DexelGrid grid, const Frame& part_frame, FindingList& findings);

  /// What is in the spindle from now on. One without a shape takes nothing away. Told is what of it is too thin to be
  /// found in material, as it is taken smaller by the resolution; empty: nothing.
  std::string set_tool(const Tool& tool);
  /// Tells of every cut from now on; the listener outlives this.
  void listen(CutListener& listener) noexcept { listening_.listener = &listener; }
  /// The joints have gone straight to there since they were told last, and the tool's tip is so far beside where they
  /// have it (part frame): it bends.
  void advance(double t_s, std::span<const double> joints, const MoveNow& move, bool spindle_turns,
               const Eigen::Vector3d& bend_mm = Eigen::Vector3d::Zero());
  /// What is under way counts as far as it came. To be called before anything is read.
  void finish();

  [[nodiscard]] const DexelGrid& grid() const noexcept { return grid_; }
  [[nodiscard]] RemovedVolume removed() const { return removed_.estimate(grid_); }
  [[nodiscard]] double left_mm3() const { return removed_.left_mm3(grid_); }
  /// How far the surface of what is left may be from the true one, for the motion of the tool that is taken straight.
  [[nodiscard]] double tolerance_mm() const noexcept { return tolerance_mm_; }
  [[nodiscard]] std::size_t strokes() const noexcept { return strokes_; }

 private:
  struct Part {
    std::string name;
    StrokeMaker strokes;
    bool cuts = false;
    std::vector<Sweep> waiting{};  ///< until there are enough of them
  };
  struct Listening {
    CutListener* listener = nullptr;
    ToolAt told{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};  ///< where it last heard of the tool
    std::deque<std::pair<double, Eigen::Vector3d>> way;              ///< when the tip was where, the newest last
  };
  struct Times {
    double since = 0;  ///< of the strokes under way
    double now = 0;
  };
  /// The joints and where the tool is with them.
  struct Stand {
    std::span<const double> joints;
    Eigen::Vector3d bend_mm;
    ToolAt tool;
  };
  struct Last {
    std::vector<double> joints{};
    Eigen::Vector3d bend_mm{0, 0, 0};
    ToolAt tool{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};
  };
  [[nodiscard]] Stand stand(std::span<const double> joints, const Eigen::Vector3d& bend_mm);
  [[nodiscard]] bool turns_between(std::span<const double> from, std::span<const double> to) const;
  void go_between(const Stand& from, const Stand& to, int halvings);
  void go_to(const ToolAt& there);
  [[nodiscard]] Eigen::Vector3d velocity(double t_s, const Eigen::Vector3d& tip);
  void tell_listener(double t_s, const Stand& there);
  void end_strokes(bool cutting);
  void take(Part& part, const Stroke& stroke);
  void cut_all();
  void cut_with(Part& part);
  void look_at(const Part& part, const Sweep& sweep);
  void tell(const Part& part, const Removal& met, const char* why);

  LinkChain chain_;
  DexelGrid grid_;
  FindingList& findings_;
  Frame to_part_, part_frame_;  ///< machine to part, and back
  double tolerance_mm_;
  double within_mm_;  ///< that parts which do not cut are taken smaller by
  std::vector<Part> parts_;
  Frame tip_home_;  ///< of the tool's tip, all joints at 0, machine frame
  bool spindle_needed_ = true;
  RemovedSum removed_;
  std::size_t strokes_ = 0;
  Listening listening_;

  // The step under way.
  std::vector<Frame> links_;
  Last at_;
  MoveNow move_;
  bool begun_ = false, turns_ = false;
  Times s_;
};

}  // namespace rmac::gateway
