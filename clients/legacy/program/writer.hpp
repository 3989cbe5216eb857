#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace rmac::legacy {

/// As far as the API takes a coordinate (docs/api.md); no NaN is within.
inline constexpr double kFarthest_mm = 1e6;
/// Whether the API takes it as a feed, in mm/min.
[[nodiscard]] constexpr bool is_feed(double mm_min) noexcept {
  return mm_min >= 0.01 && mm_min <= 1e6;
}

/// X, Y, Z in mm.
using Point = std::array<double, 3>;

/// The unit vector along X, Y or Z.
[[nodiscard]] constexpr Point unit_axis(std::size_t axis) noexcept {
  return {axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0};
}

struct Arc {
  Point centre{}, end{};
  Point axis = unit_axis(2);  ///< about which it turns, of unit length
  bool counter_clockwise = false, closed = false;
  int more_turns = 0;
};

/// A rational B-spline with even knots, from its first point to its last.
struct Nurbs {
  int degree = 3;
  std::vector<Point> points;    ///< more than the degree
  std::vector<double> weights;  ///< of each, or none
};

/// Tip and axis of the tool: a spline of degree 5 in even pieces, between which the second derivative is continuous
/// (all inner knots are threefold), so it has three points a piece, and three more.
struct PoseSpline {
  using Pose = std::array<double, 6>;  ///< mm, and a direction of about unit length
  std::vector<Pose> points;
  int pieces = 0;
};

/// Ids of the requests: their numbers, or the lines of the source that they come from, for a reader who names those.
enum class Ids { Numbers, Lines };

/// Writes the requests of a `.rmac` file. The MoveID of each is the line of the source that it comes from.
class Writer {
 public:
  using Sink = std::function<void(std::string_view text)>;
  explicit Writer(Sink sink, Ids ids = Ids::Numbers) : sink_(std::move(sink)), ids_(ids) {}

  void at_line(std::size_t line) noexcept { line_ = line; }
  [[nodiscard]] std::size_t line() const noexcept { return line_; }

  /// Positioning, from rest to rest.
  void rapid(const Point& end);
  /// Positioning by all joints together, from rest to rest.
  void rapid_of_joints(const Point& end);
  /// Of the end of the moves that follow: from the part towards the spindle, of unit length. Z unless it is said; along
  /// a line and an arc it turns from that of the move before.
  void tool_axis(const Point& axis);
  /// Lines and arcs begin where the move before them ended, or where begin() says.
  void begin(const Point& start);
  void line(const Point& end);
  void arc(const Arc& arc);
  void nurbs(const Nurbs& curve);
  /// Its end has the axis that tool_axis() said.
  void pose_spline(const PoseSpline& curve);

  void feed(double mm_min);
  void path_tolerance(double mm);
  void part_frame(const Point& origin);
  void dwell(double seconds);
  void stop(bool optional, std::string_view message);
  void change_tool(int number);
  void await_input(std::string_view name, bool on, double time_out_s);
  void output(std::string_view name, bool on);
  /// Calls between moves, each as text of JSON.
  void in_turn(std::string_view calls);
  void flush();

  [[nodiscard]] std::size_t requests() const noexcept { return requests_; }
  [[nodiscard]] std::size_t moves() const noexcept { return moves_; }
  [[nodiscard]] std::size_t bytes() const noexcept { return flushed_ + out_.size(); }

 private:
  /// `frame`: the name of its target, with quotes and colon.
  void position(std::string_view method, std::string_view frame, const Point& end);
  void open(std::string_view method);
  void open_move(std::string_view method);
  void close();
  void write_ends();

  Sink sink_;
  std::string axis_here_ = "[0,0,1]", axis_there_ = "[0,0,1]";
  Ids ids_;
  std::string out_, here_, there_;
  std::size_t line_ = 0, requests_ = 0, moves_ = 0, flushed_ = 0;
};

}  // namespace rmac::legacy
