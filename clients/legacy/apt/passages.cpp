#include "clients/legacy/apt/passages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace rmac::apt {

namespace {

constexpr int kDeepest = 8, kMostCopies = 10'000, kMostNumber = 999'999;
/// What asks for more is a slip.
constexpr std::size_t kMostRepeated = 500'000, kMostMoves = 2'000'000;
constexpr double kSmallestDegree = 1e-12;

double exact(double value) {
  return std::abs(value) < kSmallestDegree                 ? 0
         : std::abs(std::abs(value) - 1) < kSmallestDegree ? std::copysign(1, value)
                                                           : value;
}

/// A turn of `degrees` about X, Y or Z, from the first of the other two axes towards the second.
Placement turn(std::size_t about, double degrees) {
  const double angle = std::remainder(degrees, 360) / 180 * std::numbers::pi;
  const double c = exact(std::cos(angle)), s = exact(std::sin(angle));
  const std::size_t first = (about + 1) % 3, second = (about + 2) % 3;
  Point to_first{}, to_second{};
  to_first.at(first) = c;
  to_first.at(second) = s;
  to_second.at(first) = -s;
  to_second.at(second) = c;
  Placement placement;
  for (const auto& [axis, to] : {std::pair{first, to_first}, std::pair{second, to_second}})
    (axis == 0 ? placement.x : axis == 1 ? placement.y : placement.z) = to;
  return placement;
}

/// What each copy does to the one before it.
Placement step_of(Arguments& arguments, const Coordinates& coordinates) {
  if (arguments.take("SAME")) return {};
  Placement step;
  if (arguments.take("TRANSL")) {
    const Point shift{arguments.number("x"), arguments.number("y"), arguments.number("z")};
    step.shift = scaled(coordinates.unit_mm(arguments.place()), shift);
    return step;
  }
  std::size_t axis = 0;
  for (const std::string_view word : {"YZROT", "ZXROT", "XYROT"}) {
    if (arguments.take(word)) return turn(axis, arguments.number("degrees"));
    ++axis;
  }
  refuse(arguments.next_place(), "COPY is taken with SAME, TRANSL, XYROT, YZROT and ZXROT");
}

/// The element with the parameters' values in the place of their names.
void fill_in(Element& element, const std::map<std::string, Element>& values) {
  if (element.kind == Element::Kind::Word) {
    if (const auto found = values.find(element.word); found != values.end()) {
      const std::size_t place = element.place;
      element = found->second;
      element.place = place;
    }
    return;
  }
  for (Element& inner : element.inner) fill_in(inner, values);
}

}  // namespace

bool Passages::take(Statement& statement) {
  synonyms_.replace_in(statement);
  return take_meant(statement);
}

bool Passages::take_meant(const Statement& statement) {
  if (!defining_.empty()) {
    define(statement);
    return true;
  }
  for (auto& [number, passage] : indexed_) {
    if (passage.depth != depth_ || statement.major == "$$") continue;
    if (passage.statements.size() == kMostRepeated) {
      refuse(statement.place, fmt::format("more than half a million statements stand behind INDEX/{}, for a COPY that "
                                          "did not come yet; have the CAM system write them out",
                                          number));
    }
    passage.statements.push_back(statement);
  }
  return take_verb(statement);
}

bool Passages::take_verb(const Statement& statement) {
  const std::string& major = statement.major;
  Arguments arguments(statement);
  if (!statement.name.empty() && major != "MACRO")
    refuse(statement.place,
           fmt::format("{}: names of geometry are of an APT part program; import its CL file", statement.name));
  if (major == "SYN") {
    synonyms_.add(arguments);
  } else if (major == "INDEX") {
    index(arguments);
  } else if (major == "COPY") {
    copy(arguments);
  } else if (major == "MACRO") {
    if (statement.name.empty()) refuse(statement.place, "a MACRO has a name: NAME=MACRO");
    begin(statement.name, arguments, statement);
  } else if (major == "DEFSUB") {
    begin(fmt::format("#{}", arguments.integer("a subprogram's number", kMostNumber)), arguments, statement);
  } else if (major == "CALL") {
    call(statement);
  } else if (major == "CALSUB") {
    call_subprogram(arguments);
  } else if (major == "TERMAC" || major == "ENDSUB") {
    refuse(statement.place, fmt::format("{} without what it ends", major));
  } else {
    return interpreter_.execute(statement);
  }
  return true;
}

void Passages::begin(const std::string& name, Arguments& arguments, const Statement& statement) {
  Passage passage{.statements = {}, .parameters = {}, .place = statement.place, .depth = depth_};
  while (!arguments.done()) {
    const Element& parameter = arguments.any("a parameter");
    if (name.starts_with('#') || (parameter.kind != Element::Kind::Word && parameter.kind != Element::Kind::Assigned))
      refuse(parameter.place, fmt::format("{}: this is no parameter's name", statement.major));
    passage.parameters.push_back(parameter);
  }
  if (!named_.emplace(name, std::move(passage)).second)
    refuse(statement.place, fmt::format("{} {} is there already", statement.major, name));
  defining_ = name;
}

void Passages::define(const Statement& statement) {
  const bool is_macro = !defining_.starts_with('#');
  if (statement.major == (is_macro ? "TERMAC" : "ENDSUB")) {
    Arguments(statement).end();
    defining_.clear();
  } else if (statement.major == "MACRO" || statement.major == "DEFSUB") {
    refuse(statement.place, "a MACRO or DEFSUB within another one");
  } else if (statement.major == "FINI") {
    refuse(statement.place, fmt::format("FINI before the end of {}", defining_));
  } else if (statement.major != "$$") {
    named_.at(defining_).statements.push_back(statement);
  }
}

void Passages::index(Arguments& arguments) {
  const int number = arguments.integer("the number of a passage", kMostNumber);
  arguments.end();
  const Passage passage{.statements = {}, .parameters = {}, .place = arguments.place(), .depth = depth_};
  if (indexed_.size() == kDeepest) refuse(arguments.place(), "too many INDEX whose COPY has not come");
  if (!indexed_.emplace(number, passage).second)
    refuse(arguments.place(), fmt::format("INDEX/{} has no COPY yet", number));
}

void Passages::copy(Arguments& arguments) {
  const std::size_t place = arguments.place();
  const int number = arguments.integer("the number of its INDEX", kMostNumber);
  const auto found = indexed_.find(number);
  if (found == indexed_.end() || found->second.depth != depth_)
    refuse(place, fmt::format("no INDEX/{} before this COPY that has none yet; write one for each COPY", number));
  Coordinates& coordinates = interpreter_.coordinates();
  const Placement step = step_of(arguments, coordinates);
  const int copies = arguments.done() ? 1 : arguments.integer("the number of copies", kMostCopies);
  arguments.end();
  std::vector<Statement> statements = std::move(found->second.statements);
  indexed_.erase(found);
  statements.pop_back();  // this COPY itself
  const Placement outer = coordinates.placement();
  Placement steps;
  for (int done = 0; done < copies; ++done) {
    steps = step.after(steps);
    coordinates.set_placement(outer.after(steps));
    run(statements, place);
  }
  coordinates.set_placement(outer);
}

void Passages::call(const Statement& statement) {
  Arguments arguments(statement);
  const std::string& name = arguments.word("a macro's name");
  const auto found = named_.find(name);
  if (found == named_.end()) refuse(arguments.last_place(), fmt::format("there is no macro {} before this", name));
  std::map<std::string, Element> values;
  for (const Element& parameter : found->second.parameters) {
    Element value;
    if (parameter.kind == Element::Kind::Assigned) value = parameter.inner.front();
    values[parameter.word] = value;
  }
  while (!arguments.done()) {
    const Element& given = arguments.any("a parameter");
    if (given.kind != Element::Kind::Assigned || !values.contains(given.word))
      refuse(given.place, fmt::format("this is no parameter of {}", name));
    values[given.word] = given.inner.front();
  }
  for (const auto& [parameter, value] : values) {
    if (value.kind == Element::Kind::Empty)
      refuse(statement.place, fmt::format("{} of {} is not given", parameter, name));
  }
  std::vector<Statement> statements = found->second.statements;
  for (Statement& each : statements) {
    for (Element& element : each.elements) fill_in(element, values);
  }
  run(statements, statement.place);
}

void Passages::call_subprogram(Arguments& arguments) {
  const int number = arguments.integer("a subprogram's number", kMostNumber);
  arguments.end();
  const auto found = named_.find(fmt::format("#{}", number));
  if (found == named_.end()) refuse(arguments.place(), fmt::format("there is no DEFSUB/{} before this", number));
  run(found->second.statements, arguments.place());
}

void Passages::count_repeated(std::size_t place) {
  if (++repeated_ > kMostRepeated || writer_.moves() > kMostMoves)
    refuse(place,
           "this repeats more than half a million statements, or makes more than two million moves; have the CAM "
           "system write it out, or cut it into several files");
}

void Passages::run(const std::vector<Statement>& statements, std::size_t place) {
  if (depth_ == kDeepest) refuse(place, "calls and copies within each other are too many; a macro may call itself");
  ++depth_;
  count_repeated(place);
  for (const Statement& statement : statements) {
    count_repeated(place);
    writer_.at_line(statement.line);
    if (!take_meant(statement)) refuse(statement.place, "FINI within what is repeated");
  }
  --depth_;
}

void Passages::end(std::size_t place) {
  if (!defining_.empty()) refuse(named_.at(defining_).place, fmt::format("{} does not end", defining_));
  if (!indexed_.empty())
    refuse(indexed_.begin()->second.place, fmt::format("INDEX/{} has no COPY", indexed_.begin()->first));
  interpreter_.end(place);
}

}  // namespace rmac::apt
