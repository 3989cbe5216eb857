#pragma once

#include <string>
#include <vector>

namespace rmac::bench {

/// What was measured for one row, and what it was to reach.
struct Figure {
  std::string name;
  double value = 0;
  std::string unit;
  std::string target;  ///< as in "<= 3.08"; empty where the figure only informs
  bool ok = false;
  bool measured = false;
  std::string note;  ///< why a figure is missing, or how many cases stand behind it
};

/// Prints each figure as it comes, one JSON line each, and all of them as a table at the end.
class Figures {
 public:
  void at_most(const std::string& name, double value, double target, const std::string& unit,
               const std::string& note = "");
  void at_least(const std::string& name, double value, double target, const std::string& unit,
                const std::string& note = "");
  /// No target: for the reader.
  void inform(const std::string& name, double value, const std::string& unit, const std::string& note = "");
  /// Could not be measured. Counts as missed.
  void missing(const std::string& name, const std::string& target, const std::string& unit, const std::string& why);

  void print_table() const;
  [[nodiscard]] bool all_ok() const;

 private:
  void add(Figure figure);
  std::vector<Figure> figures_;
};

/// The value that `part` (0 to 1) of the sorted values do not exceed.
[[nodiscard]] double quantile(std::vector<double> values, double part);

}  // namespace rmac::bench
