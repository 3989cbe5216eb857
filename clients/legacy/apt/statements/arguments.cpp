#include "clients/legacy/apt/statements/arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rmac::apt {

namespace {

std::string shown(const Element& element) {
  switch (element.kind) {
    case Element::Kind::Empty:
      return "nothing";
    case Element::Kind::Number:
      return fmt::format("{:g}", element.value);
    case Element::Kind::Group:
      return fmt::format("({}/…)", element.word);
    case Element::Kind::Assigned:
      return fmt::format("{}=…", element.word);
    case Element::Kind::Word:
      break;
  }
  return element.word;
}

}  // namespace

void Arguments::refuse_next(std::string_view expected) const {
  if (done()) refuse(place_, fmt::format("{} lacks {}", major_, expected));
  refuse(elements_[at_].place, fmt::format("{}: {} where {} is to stand", major_, shown(elements_[at_]), expected));
}

bool Arguments::take(std::string_view word) {
  if (!has_word() || elements_[at_].word != word) return false;
  ++at_;
  return true;
}

const std::string& Arguments::word(std::string_view expected) {
  if (!has_word()) refuse_next(expected);
  return elements_[at_++].word;
}

double Arguments::number(std::string_view expected) {
  if (!has_number()) refuse_next(expected);
  return elements_[at_++].value;
}

int Arguments::integer(std::string_view expected, int most) {
  if (!has_number()) refuse_next(expected);
  const double value = elements_[at_].value;
  if (value != std::round(value) || value < 0 || value > most)
    refuse(elements_[at_].place, fmt::format("{}: {} is a whole number, 0 to {}", major_, expected, most));
  ++at_;
  return static_cast<int>(value);
}

const Element& Arguments::group(std::string_view word) {
  if (!is(Element::Kind::Group) || elements_[at_].word != word) refuse_next(fmt::format("({}/…)", word));
  return elements_[at_++];
}

const Element& Arguments::any(std::string_view expected) {
  if (done()) refuse_next(expected);
  return elements_[at_++];
}

std::vector<double> Arguments::numbers(std::initializer_list<std::size_t> counts, std::string_view expected) {
  std::vector<double> values;
  while (has_number()) values.push_back(elements_[at_++].value);
  if (std::find(counts.begin(), counts.end(), values.size()) == counts.end()) {
    refuse(done() ? place_ : elements_[at_].place,
           fmt::format("{} has {}, which are {} numbers, and here are {}", major_, expected, fmt::join(counts, " or "),
                       values.size()));
  }
  return values;
}

void Arguments::end() const {
  if (!done())
    refuse(elements_[at_].place, fmt::format("{}: {} is not understood here", major_, shown(elements_[at_])));
}

}  // namespace rmac::apt
