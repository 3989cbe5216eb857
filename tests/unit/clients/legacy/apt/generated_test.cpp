#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "clients/legacy/rs274/import.hpp"
#include "unit/clients/legacy/apt/imported.hpp"

namespace rmac::apt {
namespace {

using Vector = std::array<double, 3>;

constexpr double kTurn = 2 * std::numbers::pi;

Vector sum(const Vector& a, double factor, const Vector& b) {
  return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}
double product(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vector across(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double distance(const Vector& a, const Vector& b) {
  const Vector way = sum(a, -1, b);
  return std::sqrt(product(way, way));
}

/// What a program asks for, told by who wrote it.
struct Wanted {
  std::string method;
  Vector end{};
  Vector centre{}, rotation{};  ///< of arcs: about which it turns by the right hand
  bool closed = false;
  int turns = 0;
};

/// Writes programs whose moves are known because they were made before the text.
class Author {
 public:
  explicit Author(unsigned seed) : random_(seed) { text_ = "UNITS/MM\nFEDRAT/600,MMPM\n"; }

  void rapid() {
    here_ = point();
    text_ += "RAPID\n";
    go({"MoveToPathTarget", here_});
  }

  void line() {
    here_ = point();
    go({"MoveAlongLine", here_});
  }

  /// As CATIA writes it, in a plane along XY.
  void followed_arc() {
    const Arc arc = arc_about({0, 0, number(0, 1) < 0.5 ? 1.0 : -1.0}, number(0.2, kTurn - 0.2), 0);
    text_ += fmt::format("INDIRV/{}\nTLON,GOFWD/(CIRCLE/{},{:.6f}),ON,{}(LINE/{},$\n  {})\n", shown(arc.tangent),
                         shown(arc.centre), arc.radius, arc.sweep > std::numbers::pi ? "2,INTOF," : "",
                         shown(arc.centre), shown(arc.end));
    take(arc, 0);
  }

  /// As NX writes it: clockwise about an axis that points anywhere, and a helix at times.
  void recorded_arc() {
    const Vector rotation = direction();
    const bool closed = number(0, 1) < 0.2;
    const int turns = closed ? static_cast<int>(number(0, 3)) : 0;
    const Arc arc =
        arc_about(rotation, closed ? kTurn : number(0.2, kTurn - 0.2), number(0, 1) < 0.5 ? 0 : number(-5, 5));
    text_ +=
        fmt::format("CIRCLE/{},{},{:.6f},.06,.5,10.,0.{}\nGOTO/{}\n", shown(arc.centre), shown(sum({}, -1, rotation)),
                    arc.radius, closed ? fmt::format(",TIMES,{}", turns + 1) : "", shown(arc.end));
    take(arc, turns);
  }

  void angled_arc() {
    const int turns = static_cast<int>(number(0, 3));
    const Arc arc = arc_about(direction(), number(0.2, kTurn - 0.2), number(-5, 5));
    text_ += fmt::format("MOVARC/{},{},{:.6f},ANGLE,{:.4f}\nGOTO/{}\n", shown(arc.centre), shown(arc.rotation),
                         arc.radius, (arc.sweep / kTurn + turns) * 360, shown(arc.end));
    take(arc, turns);
  }

  void any_move() {
    const std::array moves{&Author::rapid, &Author::line, &Author::followed_arc, &Author::recorded_arc,
                           &Author::angled_arc};
    (this->*moves.at(static_cast<std::size_t>(number(0, static_cast<double>(moves.size()) - 1e-9))))();
  }

  [[nodiscard]] std::string program() const { return text_ + "FINI\n"; }
  [[nodiscard]] const std::vector<Wanted>& wanted() const { return wanted_; }

 private:
  struct Arc {
    Vector centre{}, rotation{}, tangent{}, end{};
    double radius = 0, sweep = 0;
  };

  double number(double least, double most) { return std::uniform_real_distribution(least, most)(random_); }
  Vector point() { return {number(-50, 50), number(-50, 50), number(-50, 50)}; }
  static std::string shown(const Vector& v) { return fmt::format("{:.6f},{:.6f},{:.6f}", v[0], v[1], v[2]); }

  /// Exact to the digits that are written, so that the text says what is meant.
  Vector direction() {
    const double which = number(0, 1);
    if (which < 0.3) return {0, 0, which < 0.15 ? 1.0 : -1.0};
    if (which < 0.4) return {which < 0.35 ? 1.0 : -1.0, 0, 0};
    if (which < 0.5) return {0, which < 0.45 ? 1.0 : -1.0, 0};
    if (which < 0.6) return {0.6, 0, -0.8};
    return {2. / 7, -3. / 7, 6. / 7};
  }

  Arc arc_about(const Vector& rotation, double sweep, double rise) {
    Vector outward = across(rotation, std::abs(rotation[0]) < 0.5 ? Vector{1, 0, 0} : Vector{0, 1, 0});
    outward = sum({}, 1 / std::sqrt(product(outward, outward)), outward);
    const Vector ahead = across(rotation, outward);
    const double angle = number(0, kTurn);
    const Vector spoke = sum(sum({}, std::cos(angle), outward), std::sin(angle), ahead);
    Arc arc{.rotation = rotation, .radius = number(1, 40), .sweep = sweep};
    arc.centre = sum(here_, -arc.radius, spoke);
    arc.tangent = across(rotation, spoke);
    const Vector last = sum(sum({}, std::cos(sweep), spoke), std::sin(sweep), arc.tangent);
    arc.end = sum(sum(arc.centre, arc.radius, last), rise, rotation);
    return arc;
  }

  void go(const Wanted& wanted) {
    text_ += fmt::format("GOTO/{}\n", shown(wanted.end));
    wanted_.push_back(wanted);
  }
  void take(const Arc& arc, int turns) {
    wanted_.push_back({"MoveAlongArc", arc.end, arc.centre, arc.rotation, arc.sweep == kTurn, turns});
    here_ = arc.end;
  }

  std::mt19937 random_;
  std::string text_;
  Vector here_{};
  std::vector<Wanted> wanted_;
};

void expect_same(const json& move, const Wanted& wanted) {
  constexpr double kDigits = 1e-4;  // six are written, and a centre is moved to be evenly far from both ends
  constexpr double kEnd = 1e-5;     // a full circle ends where it began, seen along its axis of six digits
  EXPECT_EQ(move["method"], "RMAC_CAM." + wanted.method);
  EXPECT_LT(distance(end_of(move)["p"].get<Vector>(), wanted.end), kEnd);
  if (wanted.method != "MoveAlongArc") return;
  const json& params = move["params"];
  EXPECT_LT(distance(params["CenterPoint"]["p"].get<Vector>(), wanted.centre), kDigits);
  const Vector rotation = sum({}, params["RotSign"].get<double>(), params["CenterPoint"]["axis"].get<Vector>());
  EXPECT_LT(distance(rotation, wanted.rotation), 2e-6);
  EXPECT_EQ(params["Closed"].get<bool>(), wanted.closed);
  EXPECT_EQ(params.value("Turns", 0), wanted.turns);
}

TEST(AptGenerated, MovesAreThoseThatTheirAuthorMeant) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    Author author(seed);
    author.rapid();
    for (int i = 0; i < 40; ++i) author.any_move();
    std::vector<json> moves;
    for (const json& request : imported(author.program()).requests) {
      if (request["params"].contains("MoveID")) moves.push_back(request);
    }
    ASSERT_EQ(moves.size(), author.wanted().size()) << author.program();
    for (std::size_t i = 0; i < moves.size() && !HasFailure(); ++i) {
      SCOPED_TRACE(moves[i].dump());
      expect_same(moves[i], author.wanted()[i]);
    }
    ASSERT_FALSE(HasFailure()) << author.program();
  }
}

/// One geometry in both languages, with the same digits.
struct Both {
  std::string apt = "UNITS/MM\nFEDRAT/600,MMPM\nRAPID\nGOTO/0.0000,0.0000,30.0000\n";
  std::string rs274 = "G21 G90 G90.1 F600\nG0 X0 Y0 Z30\n";
};

std::string point_of(const std::array<std::string, 3>& digits) {
  return fmt::format("{},{},{}", digits[0], digits[1], digits[2]);
}

/// Adds a move, and where it ends to `here`.
void add_move(Both& both, Vector& here, std::mt19937& random) {
  const auto number = [&random](double least, double most) {
    return std::uniform_real_distribution(least, most)(random);
  };
  const auto digits = [](const Vector& v) {
    return std::array{fmt::format("{:.4f}", v[0]), fmt::format("{:.4f}", v[1]), fmt::format("{:.4f}", v[2])};
  };
  const double kind = number(0, 1);
  if (kind < 0.5) {
    here = {number(-40, 40), number(-40, 40), number(-40, 40)};
    const auto end = digits(here);
    both.apt += fmt::format("{}GOTO/{}\n", kind < 0.2 ? "RAPID\n" : "", point_of(end));
    both.rs274 += fmt::format("G{} X{} Y{} Z{}\n", kind < 0.2 ? 0 : 1, end[0], end[1], end[2]);
    return;
  }
  const std::size_t normal = static_cast<std::size_t>(number(0, 3 - 1e-9)), first = (normal + 1) % 3,
                    second = (normal + 2) % 3;
  const bool counter_clockwise = number(0, 1) < 0.5;
  const double radius = number(1, 30), angle = number(0, kTurn),
               sweep = (counter_clockwise ? 1 : -1) * number(0.1, kTurn - 0.1);
  Vector centre = here;
  centre.at(first) -= radius * std::cos(angle);
  centre.at(second) -= radius * std::sin(angle);
  Vector end = here;
  end.at(first) = centre.at(first) + radius * std::cos(angle + sweep);
  end.at(second) = centre.at(second) + radius * std::sin(angle + sweep);
  if (number(0, 1) < 0.5) end.at(normal) += number(-5, 5);
  Vector axis{};
  axis.at(normal) = counter_clockwise ? -1 : 1;
  const auto at = digits(centre), to = digits(end);
  both.apt += fmt::format("CIRCLE/{},{:.1f},{:.1f},{:.1f},{:.4f},.06,.5,10.,0.\nGOTO/{}\n", point_of(at), axis[0],
                          axis[1], axis[2], radius, point_of(to));
  constexpr std::array kPlanes{19, 18, 17};
  constexpr std::array kLetters{'I', 'J', 'K'};
  both.rs274 += fmt::format("G{} G{} X{} Y{} Z{} {}{} {}{}\n", kPlanes.at(normal), counter_clockwise ? 3 : 2, to[0],
                            to[1], to[2], kLetters.at(first), at.at(first), kLetters.at(second), at.at(second));
  here = end;
}

/// Requests as they are apart from the lines that they come from.
std::vector<json> without_lines(std::vector<json> requests) {
  for (json& request : requests) {
    request.erase("id");
    request["params"].erase("MoveID");
  }
  return requests;
}

void expect_same_requests(const Both& both) {
  std::string text;
  const auto summary = rs274::import_program(both.rs274 + "M2\n", {}, [&text](std::string_view part) { text += part; });
  ASSERT_TRUE(summary) << summary.error().line << ": " << summary.error().message << "\n" << both.rs274;
  const auto ours = without_lines(imported(both.apt + "FINI\n").requests), theirs = without_lines(requests_in(text));
  ASSERT_GT(ours.size(), 1U);
  ASSERT_EQ(ours, theirs) << both.apt << both.rs274;
}

TEST(AptGenerated, MovesAreThoseOfTheSameGeometryInRs274) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    Both both;
    Vector here{0, 0, 30};
    for (int i = 0; i < 40; ++i) add_move(both, here, random);
    expect_same_requests(both);
  }
}

TEST(AptGenerated, HolesAreThoseOfTheSameCyclesInRs274) {
  struct Pair {
    const char *apt, *rs274;
    bool dwells, pecks;
  };
  constexpr std::array<Pair, 5> kCycles{{{"DRILL", "G81", false, false},
                                         {"DRILL", "G82", true, false},
                                         {"DEEP", "G83", false, true},
                                         {"BRKCHP", "G73", false, true},
                                         {"REAM", "G85", false, false}}};
  for (unsigned seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const auto number = [&random](double least, double most) {
      return std::uniform_real_distribution(least, most)(random);
    };
    const Pair& pair = kCycles.at(seed % kCycles.size());
    const int depth = static_cast<int>(number(1, 20)), clear = static_cast<int>(number(1, 5)),
              peck = static_cast<int>(number(1, 6));
    Both both;
    both.apt += fmt::format("CYCLE/{},DEPTH,{},CLEAR,{}{}{}\n", pair.apt, depth, clear,
                            pair.pecks ? fmt::format(",STEP,{}", peck) : "", pair.dwells ? ",DWELL,1.5" : "");
    for (int hole = 0; hole < 4; ++hole) {
      const int x = static_cast<int>(number(-30, 30)), y = static_cast<int>(number(-30, 30)),
                top = static_cast<int>(number(-9, 9));
      both.apt += fmt::format("GOTO/{},{},{}\n", x, y, top);
      both.rs274 += fmt::format("G99 {} X{} Y{} Z{} R{}{}{}\n", pair.rs274, x, y, top - depth, top + clear,
                                pair.pecks ? fmt::format(" Q{}", peck) : "", pair.dwells ? " P1.5" : "");
    }
    both.apt += "CYCLE/OFF\n";
    expect_same_requests(both);
  }
}

}  // namespace
}  // namespace rmac::apt
