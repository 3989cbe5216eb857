#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

namespace rmac::fieldbus {

/// The parameters of one bus out of `device.json`: those named `bus.name`, and those named `name` where there is none.
/// Keeps the first mistake, so that a reader can ask for all values first and look once.
class Parameters {
 public:
  enum class Kind { Whole, Any };

  /// `interface` is for messages; `axis_list` names the parameter that has one number for each axis.
  Parameters(std::string interface, std::string axis_list, std::string bus,
             const std::map<std::string, std::vector<double>>& numbers, const std::map<std::string, std::string>& texts)
      : interface_(std::move(interface)),
        axis_list_(std::move(axis_list)),
        bus_(std::move(bus)),
        numbers_(numbers),
        texts_(texts) {}

  [[nodiscard]] double number(const std::string& name, double otherwise, double least, double most,
                              Kind kind = Kind::Whole);
  /// One number for all axes, or one for each.
  [[nodiscard]] double number_of_axis(const std::string& name, std::size_t axis, double otherwise, double least,
                                      double most, Kind kind = Kind::Whole);
  [[nodiscard]] std::string text(const std::string& name, const std::string& otherwise);
  /// `name_axis` where it is given, else `name`.
  [[nodiscard]] std::string text_of_axis(const std::string& name, std::size_t axis, const std::string& otherwise) const;
  /// As many as the list of axes has numbers.
  [[nodiscard]] std::size_t axes();

  /// A mistake: the first one is kept. An empty text is none.
  void refuse(const std::string& what);
  void refuse_unknown();
  [[nodiscard]] bool sound() const { return problem_.empty(); }
  [[nodiscard]] const std::string& problem() const { return problem_; }
  [[nodiscard]] std::string place(const std::string& what) const {
    return interface_ + (bus_.empty() ? "" : ", bus " + bus_) + ": " + what;
  }

 private:
  [[nodiscard]] const std::vector<double>* find_numbers(const std::string& name) const;
  [[nodiscard]] const std::string* find_text(const std::string& name) const;
  [[nodiscard]] double checked(const std::string& name, double value, double least, double most, Kind kind);

  std::string interface_;
  std::string axis_list_;
  std::string bus_;
  const std::map<std::string, std::vector<double>>& numbers_;
  const std::map<std::string, std::string>& texts_;
  mutable std::set<std::string> asked_;
  std::string problem_;
};

}  // namespace rmac::fieldbus
