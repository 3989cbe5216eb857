#include "parameters.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace rmac::fieldbus {

const std::vector<double>* Parameters::find_numbers(const std::string& name) const {
  asked_.insert(name);
  for (const std::string& key : {bus_ + "." + name, name}) {
    if (const auto found = numbers_.find(key); found != numbers_.end()) return &found->second;
  }
  return nullptr;
}

const std::string* Parameters::find_text(const std::string& name) const {
  asked_.insert(name);
  for (const std::string& key : {bus_ + "." + name, name}) {
    if (const auto found = texts_.find(key); found != texts_.end()) return &found->second;
  }
  return nullptr;
}

void Parameters::refuse(const std::string& what) {
  if (problem_.empty() && !what.empty()) problem_ = place(what);
}

double Parameters::checked(const std::string& name, double value, double least, double most, Kind kind) {
  const bool whole = kind == Kind::Any || value == std::floor(value);
  if (value >= least && value <= most && whole) return value;
  refuse(fmt::format("{} is {}; allowed is a {}number from {} to {}", name, value, kind == Kind::Whole ? "whole " : "",
                     least, most));
  return least;
}

double Parameters::number(const std::string& name, double otherwise, double least, double most, Kind kind) {
  const std::vector<double>* values = find_numbers(name);
  if (values == nullptr) return otherwise;
  if (values->size() == 1) return checked(name, values->front(), least, most, kind);
  refuse(fmt::format("{} has {} values; it takes one", name, values->size()));
  return least;
}

double Parameters::number_of_axis(const std::string& name, std::size_t axis, double otherwise, double least,
                                  double most, Kind kind) {
  const std::vector<double>* values = find_numbers(name);
  if (values == nullptr) return otherwise;
  if (values->size() == 1) return checked(name, values->front(), least, most, kind);
  if (values->size() == axes()) return checked(name, (*values)[axis], least, most, kind);
  refuse(fmt::format("{} has {} values for {} axes; it takes one for all axes or one for each", name, values->size(),
                     axes()));
  return least;
}

std::string Parameters::text(const std::string& name, const std::string& otherwise) {
  const std::string* value = find_text(name);
  return value != nullptr ? *value : otherwise;
}

std::string Parameters::text_of_axis(const std::string& name, std::size_t axis, const std::string& otherwise) const {
  if (const std::string* own = find_text(fmt::format("{}_{}", name, axis)); own != nullptr) return *own;
  const std::string* shared = find_text(name);
  return shared != nullptr ? *shared : otherwise;
}

std::size_t Parameters::axes() {
  const std::vector<double>* list = find_numbers(axis_list_);
  return list != nullptr ? list->size() : 0;
}

void Parameters::refuse_unknown() {
  const auto check = [this](const std::string& key) {
    const std::size_t point = key.rfind('.');
    // What is said of another bus is that bus's to check.
    if (point != std::string::npos && key.substr(0, point) != bus_) return;
    const std::string name = point == std::string::npos ? key : key.substr(point + 1);
    if (asked_.contains(name)) return;
    refuse(fmt::format("parameter \"{}\" is not understood; there are {}", key, fmt::join(asked_, ", ")));
  };
  for (const auto& [key, ignored] : numbers_) check(key);
  for (const auto& [key, ignored] : texts_) check(key);
}

}  // namespace rmac::fieldbus
