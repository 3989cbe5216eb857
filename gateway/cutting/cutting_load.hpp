#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "gateway/cutting/engagement.hpp"
#include "gateway/forces/work_materials.hpp"
#include "gateway/material/cut_listener.hpp"
#include "gateway/tools/tool.hpp"

namespace rmac::gateway {

/// What cutting took over some time: means over the time that the tool was in material, peaks of all of it.
struct CuttingShare {
  double time_s = 0;                           ///< in material
  double mean_n = 0, mean_nm = 0, mean_w = 0;  ///< force, torque and power, each a mean over a turn
  double peak_n = 0, peak_nm = 0, peak_w = 0;  ///< the highest within a turn
};

/// A time on end in which cutting takes more than the spindle has.
struct Overload {
  enum class Of { Torque, Power };
  Of of = Of::Torque;
  int line = 0;  ///< of the program, when it began
  std::int64_t move_id = 0;
  double t_s = 0, until_s = 0;
  Eigen::Vector3d place{0, 0, 0};  ///< of the tool's tip where it was the most, part frame
  double most = 0;                 ///< mean over a turn, N·m or W
  double allowed = 0;
};

/// Means over a turn, at one place of the way.
struct CuttingNow {
  double n = 0, nm = 0, w = 0;
  Eigen::Vector3d force_n{0, 0, 0};  ///< on the tool, part frame
  Eigen::Vector3d axis{0, 0, 1};     ///< of the tool, part frame
};

/// A tool in material, at one place of the way.
struct EngagedTool {
  const EndMill& mill;
  std::span<const EngagedSlice> slices;
  ToothFeed feed;
  double rpm = 0;
  ToolAt at;             ///< part frame
  Eigen::Vector3d goes;  ///< where to, across its axis; a unit vector, or 0 where it goes along its axis
  double t_s = 0;
  MoveNow move;
};

/// Hears of every look at a tool that found it in material, with forces that could be told.
class EngagedListener {
 public:
  virtual ~EngagedListener() = default;
  virtual void engaged(const EngagedTool& tool) = 0;
};

/// What a spindle can give; 0: not known.
struct SpindlePower {
  double torque_nm = 0, power_w = 0;
};

/// Watches what the tool is pushed with as it takes the stock away. One thread.
class CuttingLoad : public CutListener {
 public:
  static constexpr std::size_t kMostOverloads = 1000;

  /// `material` as one of WorkMaterials, `rays_mm`: how far the rays of the stock are apart.
  CuttingLoad(WorkMaterial material, double rays_mm) : material_(std::move(material)), rays_mm_(rays_mm) {}

  /// What is in the spindle from now on.
  void set_tool(const Tool& tool);
  /// What turns it from now on, to the right where rpm > 0; 0 rpm where nobody knows.
  void set_spindle(double rpm, const SpindlePower& power) noexcept { rpm_ = rpm, spindle_ = power; }

  /// Tells of every look from now on; the listener outlives this.
  void listen(EngagedListener& listener) noexcept { listener_ = &listener; }

  void cuts(const DexelGrid& grid, const ToolAt& tool, const Eigen::Vector3d& velocity, double t_s,
            const MoveNow& move) override;
  void takes(double mm3) noexcept override { looks_.taken_mm3 += mm3; }
  [[nodiscard]] double every_mm() const override;
  /// A turn: what an axis does within one changes no mean over it.
  [[nodiscard]] double steady_s() const override;

  [[nodiscard]] const WorkMaterial& material() const noexcept { return material_; }
  /// What it takes as far as it was told by then; nothing in the air, and where it cannot be told.
  [[nodiscard]] CuttingNow now(double t_s) const noexcept { return t_s <= now_until_s_ ? now_ : CuttingNow{}; }
  [[nodiscard]] const CuttingShare& all() const noexcept { return all_; }
  /// Of each move that cut, by its number.
  [[nodiscard]] const std::map<std::int64_t, CuttingShare>& moves() const noexcept { return moves_; }
  /// In the order in which they began; at most `kMostOverloads`.
  [[nodiscard]] const std::vector<Overload>& overloads() const noexcept { return overloads_; }
  /// The most that cutting took of what the spindle has, of torque or power, as a mean over a turn: above 1 it had not
  /// enough. 0 where nothing was cut, or nobody knows what it has.
  [[nodiscard]] double most_used() const noexcept { return most_used_; }
  /// What is missing to tell it, a sentence each; empty: nothing.
  [[nodiscard]] const std::set<std::string>& not_told() const noexcept { return not_told_; }

 private:
  struct Span {
    double from_s = 0, to_s = 0;
  };
  /// What was computed last, which mostly stays.
  struct Last {
    std::vector<EngagedSlice> slices;
    ToothFeed feed;
    double rpm = 0;
    TurnForces forces;
  };
  struct Looks {
    double told_s = 0;     ///< when it last heard of the tool
    double taken_mm3 = 0;  ///< since then
    /// So often on end material went and no tooth was seen in any, and it went down with its face.
    int blind = 0, down = 0;
  };
  void judge(Overload::Of of, double mean, double allowed, const Span& span, const ToolAt& tool, const MoveNow& move);
  /// Whether teeth are in material now; tells of material that goes though none is seen to be.
  [[nodiscard]] bool engaged(const Engagement& met, const MoveNow& move);
  /// Whether it goes down with its face, by so much a tooth and by this share of its speed, and not only gives way as
  /// a cut begins.
  [[nodiscard]] bool plunges(const Engagement& met, double down_mm, double share);
  /// Once for each tool.
  void miss(const char* kind, const std::string& sentence);

  WorkMaterial material_;
  double rays_mm_;
  int tool_ = kNoTool;
  std::optional<EndMill> mill_;
  std::string no_mill_;  ///< why there is none
  double rpm_ = 0;
  SpindlePower spindle_;

  CuttingShare all_;
  std::map<std::int64_t, CuttingShare> moves_;
  std::vector<Overload> overloads_;
  double most_used_ = 0;
  std::set<std::string> not_told_, missed_;
  std::optional<Last> last_;
  CuttingNow now_;
  double now_until_s_ = -1;  ///< from then on nobody knows it to cut
  Looks looks_;
  EngagedListener* listener_ = nullptr;
};

}  // namespace rmac::gateway
