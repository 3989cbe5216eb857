#include "gateway/collision/ahead/segment_chords.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rmac::gateway {
namespace {

/// What is measured at three places may be so much more between them: a cubic that is 0 at the middle has its most
/// there.
constexpr double kUnseen = 2;
/// A shorter stretch is not halved.
constexpr double kShortest_mm = 1e-6;
/// However far a straight one goes, its joints are looked at this often.
constexpr double kLongest_mm = 1000;

class Halving {
 public:
  Halving(const PathSegment& segment, const Chord::Joints& most_beside) : segment_(segment), most_(most_beside) {}

  /// False where the kinematics have no joints.
  bool add(double from_s, double to_s) {
    Chord chord{from_s, to_s, {}, {}, {}};
    if (!find_joints(from_s, 1, chord.from) || !find_joints(to_s, -1, chord.to)) return false;
    return add(chord);
  }
  [[nodiscard]] std::vector<Chord> take() { return std::move(chords_); }

 private:
  bool find_joints(double s, int side, Chord::Joints& joints) const {
    JointPoint point;
    if (segment_.evaluate(s, 0, side, point) != KinematicsStatus::Ok) return false;
    std::copy_n(point.d[0].begin(), segment_.joint_count(), joints.begin());
    return true;
  }

  bool add(Chord& chord) {
    Chord::Joints middle{};
    bool straight = chord.to_s - chord.from_s <= kLongest_mm;
    for (const double at : {0.5, 0.25, 0.75}) {
      Chord::Joints joints{};
      if (!find_joints(chord.from_s + at * (chord.to_s - chord.from_s), 1, joints)) return false;
      if (at == 0.5) middle = joints;
      for (std::size_t j = 0; j < segment_.joint_count(); ++j) {
        const double beside = kUnseen * std::abs(joints[j] - (chord.from[j] + at * (chord.to[j] - chord.from[j])));
        chord.beside[j] = std::max(chord.beside[j], beside);
        straight = straight && chord.beside[j] <= most_[j];
      }
    }
    if (straight || chord.to_s - chord.from_s <= kShortest_mm) {
      chords_.push_back(chord);
      return true;
    }
    const double middle_s = (chord.from_s + chord.to_s) / 2;
    Chord first{chord.from_s, middle_s, chord.from, middle, {}}, second{middle_s, chord.to_s, middle, chord.to, {}};
    return add(first) && add(second);
  }

  const PathSegment& segment_;
  const Chord::Joints& most_;
  std::vector<Chord> chords_;
};

}  // namespace

std::vector<Chord> chords_of(const PathSegment& segment, double from_s, double to_s, const Chord::Joints& most_beside) {
  Halving halving(segment, most_beside);
  return halving.add(from_s, to_s) ? halving.take() : std::vector<Chord>();
}

}  // namespace rmac::gateway
