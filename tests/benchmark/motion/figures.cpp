#include "figures.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace rmac::bench {
namespace {

std::string number(double value) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.6g", value);
  return buffer;
}

}  // namespace

void Figures::add(Figure figure) {
  std::string value = figure.measured && std::isfinite(figure.value) ? number(figure.value) : "null";
  std::printf("{\"name\": \"%s\", \"value\": %s, \"unit\": \"%s\", \"target\": \"%s\", \"ok\": %s%s%s%s}\n",
              figure.name.c_str(), value.c_str(), figure.unit.c_str(), figure.target.c_str(),
              figure.ok ? "true" : "false", figure.note.empty() ? "" : ", \"note\": \"", figure.note.c_str(),
              figure.note.empty() ? "" : "\"");
  std::fflush(stdout);
  figures_.push_back(std::move(figure));
}

void Figures::at_most(const std::string& name, double value, double target, const std::string& unit,
                      const std::string& note) {
  add({name, value, unit, "<= " + number(target), value <= target, true, note});
}

void Figures::at_least(const std::string& name, double value, double target, const std::string& unit,
                       const std::string& note) {
  add({name, value, unit, ">= " + number(target), value >= target, true, note});
}

void Figures::inform(const std::string& name, double value, const std::string& unit, const std::string& note) {
  add({name, value, unit, "", true, true, note});
}

void Figures::missing(const std::string& name, const std::string& target, const std::string& unit,
                      const std::string& why) {
  add({name, 0, unit, target, false, false, why});
}

void Figures::print_table() const {
  std::size_t width = 4;
  for (const Figure& f : figures_) width = std::max(width, f.name.size());
  std::printf("\n%-*s  %12s  %-11s  %-14s  %-6s  %s\n", static_cast<int>(width), "work", "measured", "unit", "to reach",
              "", "");
  for (const Figure& f : figures_) {
    std::printf("%-*s  %12s  %-11s  %-14s  %-6s  %s\n", static_cast<int>(width), f.name.c_str(),
                f.measured ? number(f.value).c_str() : "-", f.unit.c_str(), f.target.c_str(),
                f.target.empty() ? ""
                : f.ok           ? "ok"
                                 : "missed",
                f.note.c_str());
  }
}

bool Figures::all_ok() const {
  return std::all_of(figures_.begin(), figures_.end(), [](const Figure& f) { return f.ok; });
}

double quantile(std::vector<double> values, double part) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  const auto last = static_cast<double>(values.size() - 1);
  return values[static_cast<std::size_t>(std::ceil(part * last - 1e-9))];
}

}  // namespace rmac::bench
