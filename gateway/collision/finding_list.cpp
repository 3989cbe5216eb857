#include "gateway/collision/finding_list.hpp"

#include <algorithm>

#include "gateway/bodies/isometry.hpp"

namespace rmac::gateway {

FindingList::FindingList(const Frame& part_frame) : to_part_(to_isometry(part_frame).inverse()) {}

Finding* FindingList::of(const std::string& first, const std::string& second, double since_s, const MoveNow& move,
                         const Meeting& meeting) {
  const auto same = std::find_if(findings_.rbegin(), findings_.rend(), [&](const Finding& f) {
    return f.first == first && f.second == second && f.possible == meeting.possible &&
           (f.until_s >= since_s || f.move_id == move.id);
  });
  if (same != findings_.rend()) return &*same;
  // What is only near leaves room for what meets.
  if (findings_.size() >= (meeting.meet ? 2 * kMost : kMost)) {
    ++left_off_;
    collided_ = collided_ || (meeting.meet && !meeting.possible);
    return nullptr;
  }
  findings_.push_back(Finding{});
  Finding& made = findings_.back();
  made.first = first, made.second = second, made.possible = meeting.possible;
  return &made;
}

void FindingList::see(Finding& finding, const Apart& apart, double depth_mm, double t_s, const MoveNow& move) {
  const bool meets = apart.most == 0, fresh = finding.distance_mm < 0;
  if (fresh || (meets && !finding.collision) || (!finding.collision && apart.most < finding.distance_mm)) {
    finding.place = to_part_ * Eigen::Vector3d((apart.on_first + apart.on_second) / 2);
    finding.distance_mm = apart.most;
    finding.t_s = t_s, finding.line = move.line, finding.move_id = move.id;
  }
  finding.until_s = std::max(finding.until_s, t_s);
  finding.collision = finding.collision || meets;
  finding.depth_mm = std::max(finding.depth_mm, depth_mm);
  collided_ = collided_ || (meets && !finding.possible);
}

std::vector<Finding> FindingList::sorted() const {
  std::vector<Finding> list(findings_.begin(), findings_.end());
  std::stable_sort(list.begin(), list.end(), [](const Finding& a, const Finding& b) { return a.t_s < b.t_s; });
  return list;
}

}  // namespace rmac::gateway
