#include "clients/legacy/program/writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace rmac::legacy {

namespace {

constexpr std::size_t kFlush_bytes = 1U << 20U;
/// What is written of a length: nobody machines a tenth of a nanometre, and sums of decimals have their digits back.
constexpr double kPerMm = 1e7;
/// Of a component of a direction: a thousandth of that a metre away.
constexpr double kPerUnit = 1e10;

double rounded(double value, double per_unit = kPerMm) {
  return std::round(value * per_unit) / per_unit + 0.0;  // no minus zero
}

void write_point(std::string& text, const Point& point) {
  fmt::format_to(std::back_inserter(text), "[{},{},{}]", rounded(point[0]), rounded(point[1]), rounded(point[2]));
}

std::string direction(const Point& axis) {
  return fmt::format("[{},{},{}]", rounded(axis[0], kPerUnit), rounded(axis[1], kPerUnit), rounded(axis[2], kPerUnit));
}

void write_frame(std::string& text, std::string_view point, std::string_view axis) {
  text.append(R"({"p":)").append(point).append(R"(,"axis":)").append(axis).append("}");
}

/// As JSON has it; what is no printable ASCII is left out.
std::string quoted(std::string_view text) {
  std::string result = "\"";
  for (const char letter : text) {
    if (letter == '"' || letter == '\\') result += '\\';
    if (letter >= ' ' && letter < '\x7f') result += letter;
  }
  return result + '"';
}

}  // namespace

void Writer::open(std::string_view method) {
  ++requests_;
  fmt::format_to(std::back_inserter(out_), R"({{"jsonrpc":"2.0","id":{},"method":"RMAC_CAM.{}","params":{{)",
                 ids_ == Ids::Lines ? line_ : requests_, method);
}

void Writer::open_move(std::string_view method) {
  open(method);
  fmt::format_to(std::back_inserter(out_), R"("MoveID":{},)", line_);
}

void Writer::close() {
  out_.append("}}\n");
  if (out_.size() >= kFlush_bytes) flush();
}

void Writer::flush() {
  sink_(out_);
  flushed_ += out_.size();
  out_.clear();
}

void Writer::tool_axis(const Point& axis) {
  axis_there_ = direction(axis);
}

/// From where the move before ended to `there_`.
void Writer::write_ends() {
  out_.append(R"("StartPoint":)");
  write_frame(out_, here_, axis_here_);
  out_.append(R"(,"EndPoint":)");
  write_frame(out_, there_, axis_there_);
  here_.swap(there_);
  axis_here_ = axis_there_;
}

void Writer::begin(const Point& start) {
  here_.clear();
  write_point(here_, start);
}

void Writer::rapid(const Point& end) {
  position("MoveToPathTarget", R"("TargetFrame":)", end);
}

void Writer::rapid_of_joints(const Point& end) {
  position("MoveToJointTarget", R"("JointTargetFrame":)", end);
}

void Writer::position(std::string_view method, std::string_view frame, const Point& end) {
  begin(end);
  open_move(method);
  out_.append(frame);
  write_frame(out_, here_, axis_there_);
  axis_here_ = axis_there_;
  close();
  ++moves_;
}

void Writer::line(const Point& end) {
  there_.clear();
  write_point(there_, end);
  if (there_ == here_ && axis_there_ == axis_here_) return;  // no way at all
  open_move("MoveAlongLine");
  write_ends();
  close();
  ++moves_;
}

void Writer::arc(const Arc& arc) {
  there_.clear();
  write_point(there_, arc.centre);
  open_move("MoveAlongArc");
  fmt::format_to(std::back_inserter(out_), R"("RotSign":{},"Closed":{},"CenterPoint":)", arc.counter_clockwise ? 1 : -1,
                 arc.closed);
  write_frame(out_, there_, direction(arc.axis));
  there_.clear();
  write_point(there_, arc.end);
  out_ += ',';
  write_ends();
  if (arc.more_turns > 0) fmt::format_to(std::back_inserter(out_), R"(,"Turns":{})", arc.more_turns);
  close();
  ++moves_;
}

void Writer::nurbs(const Nurbs& curve) {
  open_move("MoveAlongNurbs");
  fmt::format_to(std::back_inserter(out_), R"("Nurbs":{{"degree":{},"points":[)", curve.degree);
  for (const Point& point : curve.points) {
    write_point(out_, point);
    out_ += ',';
  }
  out_.back() = ']';
  const int points = static_cast<int>(curve.points.size()), inner = points - curve.degree;
  out_.append(R"(,"knots":[)");
  for (int knot = -curve.degree; knot <= points; ++knot) {
    fmt::format_to(std::back_inserter(out_), "{},", std::clamp(knot, 0, inner));
  }
  out_.back() = ']';
  if (!curve.weights.empty())
    fmt::format_to(std::back_inserter(out_), R"(,"weights":[{}])", fmt::join(curve.weights, ","));
  out_ += '}';
  close();
  here_.clear();
  write_point(here_, curve.points.back());
  ++moves_;
}

void Writer::pose_spline(const PoseSpline& curve) {
  constexpr int kDegree = 5, kInner = 3;
  open_move("MoveAlongNurbsND");
  fmt::format_to(std::back_inserter(out_), R"("NurbsND":{{"space":"pose","degree":{},"points":[)", kDegree);
  for (const auto& [x, y, z, i, j, k] : curve.points) {
    fmt::format_to(std::back_inserter(out_), "[{},{},{},{},{},{}],", rounded(x), rounded(y), rounded(z),
                   rounded(i, kPerUnit), rounded(j, kPerUnit), rounded(k, kPerUnit));
  }
  out_.back() = ']';
  out_.append(R"(,"knots":[)");
  for (int knot = 0; knot <= curve.pieces; ++knot) fmt::format_to(std::back_inserter(out_), "{},", knot);
  out_.back() = ']';
  out_.append(R"(,"multiplicities":[)");
  for (int knot = 0; knot <= curve.pieces; ++knot)
    fmt::format_to(std::back_inserter(out_), "{},", knot == 0 || knot == curve.pieces ? kDegree + 1 : kInner);
  out_.back() = ']';
  out_ += '}';
  close();
  const auto& end = curve.points.back();
  begin({end[0], end[1], end[2]});
  axis_here_ = axis_there_;
  ++moves_;
}

void Writer::feed(double mm_min) {
  open("SetFeedrate");
  fmt::format_to(std::back_inserter(out_), R"("Feedrate":{})", rounded(mm_min));
  close();
}

void Writer::path_tolerance(double mm) {
  open("SetPathTolerance");
  fmt::format_to(std::back_inserter(out_), R"("Tolerance":{})", rounded(mm));
  close();
}

void Writer::part_frame(const Point& origin) {
  open("SetPartFrame");
  out_.append(R"("PartFrame":{"p":)");
  write_point(out_, origin);
  out_.append(R"(,"q":[1,0,0,0]})");
  close();
}

void Writer::dwell(double seconds) {
  open_move("Dwell");
  fmt::format_to(std::back_inserter(out_), R"("Time":{})", seconds);
  close();
}

void Writer::stop(bool optional, std::string_view message) {
  open_move("ProgramStop");
  fmt::format_to(std::back_inserter(out_), R"("Optional":{})", optional);
  if (!message.empty()) out_.append(R"(,"Message":)").append(quoted(message));
  close();
}

void Writer::change_tool(int number) {
  open("DoToolChange");
  fmt::format_to(std::back_inserter(out_), R"("ToolNumber":{})", number);
  close();
}

void Writer::await_input(std::string_view name, bool on, double time_out_s) {
  open_move("AwaitInput");
  fmt::format_to(std::back_inserter(out_), R"("Name":{},"On":{},"TimeOut":{})", quoted(name), on, time_out_s);
  close();
}

void Writer::output(std::string_view name, bool on) {
  in_turn(fmt::format(R"({{"method":"RMAC_CAM.SetOutput","params":{{"Name":{},"On":{}}}}})", quoted(name), on));
}

void Writer::in_turn(std::string_view calls) {
  open_move("InTurn");
  out_.append(R"("Calls":[)").append(calls).append("]");
  close();
}

}  // namespace rmac::legacy
