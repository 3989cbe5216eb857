#include "clients/legacy/apt/axis_systems.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>

namespace rmac::apt {

namespace {

constexpr std::size_t kRow = 4, kMatrix = 12;
/// Numbers that differ by less than rounding are the same.
constexpr double kSame = 1e-4;

std::vector<double> numbers_in(std::string text) {
  std::ranges::replace(text, ',', ' ');
  std::istringstream words(std::move(text));
  std::vector<double> values;
  for (double value = 0; words >> value;) values.push_back(value);
  return words.eof() ? values : std::vector<double>{};
}

}  // namespace

void AxisSystems::require_first(const std::vector<double>& values, std::size_t place) {
  if (first_.empty()) first_ = values;
  const auto same = [](double a, double b) { return std::abs(a - b) <= kSame; };
  if (std::equal(values.begin(), values.end(), first_.begin(), first_.end(), same)) return;
  refuse(
      place,
      "another axis system than the first one of this program: where the two lie to each other on the machine is not "
      "known here; have the CAM system write each into a program of its own");
}

void AxisSystems::set(Arguments& arguments) {
  const auto values = arguments.numbers({9}, "an origin and two axes");
  arguments.end();
  require_first(values, arguments.place());
}

void AxisSystems::read_comment(const Statement& comment) {
  if (comment.text.starts_with("-> CSYS")) {
    const auto values = numbers_in(comment.text.substr(std::min(comment.text.find('/'), comment.text.size() - 1) + 1));
    if (values.size() == kMatrix) require_first(values, comment.place);
    return;
  }
  if (comment.text.starts_with("*CATIA0")) {
    rows_.emplace();
    return;
  }
  const auto row = rows_ ? numbers_in(comment.text) : std::vector<double>{};
  if (row.size() != kRow) return;
  rows_->insert(rows_->end(), row.begin(), row.end());
  if (rows_->size() < kMatrix) return;
  require_first(*rows_, comment.place);
  rows_.reset();
}

}  // namespace rmac::apt
