#pragma once

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rmac/modules/chain_kinematics.hpp"
#include "rmac/motion/frame_check.hpp"
#include "rmac/sdk/module.hpp"

namespace rmac::modules {

/// Reads a chain from a module's parameters (drivers/modules/README.md): `joints` names the joints in their order,
/// `chain` orders them from the part to the tool (as `joints` unless given), a parameter of each joint's name has its
/// axis (those of ISO 841 through the origin unless given), and `interface` is where the tool interface stands.
class ChainReader {
 public:
  ChainReader(sdk::Parameters parameters, std::string_view default_joints)
      : parameters_(parameters), names_(words(text("joints", default_joints))) {}

  /// Null, with the reason in `why`, for a chain that is none.
  [[nodiscard]] Kinematics* make(std::string& why) const {
    std::vector<ScrewAxis> axes;
    std::vector<std::size_t> order;
    Frame interface;
    if (names_.empty()) {
      why = "parameter joints must name the joints in their order, parted by blanks, as in \"X Y Z A C\"";
    }
    for (const std::string& name : names_) {
      if (!why.empty()) return nullptr;
      axes.push_back(axis_of(name, why));
    }
    if (why.empty()) order = chain_order(why);
    if (why.empty()) interface = interface_frame(why);
    if (why.empty()) check_known(why);
    if (!why.empty()) return nullptr;
    if (const char* fault = ChainKinematics::fault(axes)) {
      why = fault;
      return nullptr;
    }
    return new ChainKinematics(axes, order, interface);
  }

 private:
  static constexpr double kFarthest_mm = 1e6;

  [[nodiscard]] std::string_view text(std::string_view name, std::string_view otherwise) const {
    for (const sdk::Parameter& parameter : parameters_) {
      if (parameter.name == name) return parameter.text != nullptr ? parameter.text : "";
    }
    return otherwise;
  }

  [[nodiscard]] static std::vector<std::string> words(std::string_view text) {
    std::vector<std::string> found;
    while (true) {
      text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
      if (text.empty()) return found;
      found.emplace_back(text.substr(0, text.find(' ')));
      text.remove_prefix(found.back().size());
    }
  }

  /// X, Y, Z slide along their axis, A, B, C turn about it; other names say nothing.
  [[nodiscard]] static std::optional<ScrewAxis> axis_by_letter(const std::string& name) {
    static constexpr std::string_view kLetters = "XYZABC";
    const std::size_t letter = name.size() == 1 ? kLetters.find(name[0]) : std::string_view::npos;
    if (letter == std::string_view::npos) return std::nullopt;
    ScrewAxis axis;
    axis.type = letter < 3 ? JointType::Linear : JointType::Rotary;
    axis.direction = {letter % 3 == 0 ? 1.0 : 0.0, letter % 3 == 1 ? 1.0 : 0.0, letter % 3 == 2 ? 1.0 : 0.0};
    return axis;
  }

  [[nodiscard]] ScrewAxis axis_of(const std::string& name, std::string& why) const {
    const std::span<const double> numbers = sdk::find_numbers(parameters_, name.c_str());
    if (numbers.empty()) {
      if (const auto known = axis_by_letter(name)) return *known;
    }
    ScrewAxis axis;
    const bool fine = (numbers.size() == 3 || numbers.size() == 6) &&
                      std::all_of(numbers.begin(), numbers.end(), [](double n) { return std::abs(n) <= kFarthest_mm; });
    const Vector along = fine ? Vector{numbers[0], numbers[1], numbers[2]} : Vector{};
    const double size = length(along);
    if (!(size > 1e-6)) {
      why = "parameter " + name +
            " must be the joint's axis at 0: a slide's direction (3 numbers), or a turn's direction and a point on it "
            "in mm (6 numbers)";
      return axis;
    }
    axis.direction = {along[0] / size, along[1] / size, along[2] / size};
    if (numbers.size() == 6) {
      axis.type = JointType::Rotary;
      axis.point = {numbers[3], numbers[4], numbers[5]};
    }
    return axis;
  }

  [[nodiscard]] std::vector<std::size_t> chain_order(std::string& why) const {
    std::vector<std::size_t> order;
    const std::string_view given = text("chain", "");
    for (const std::string& name : given.empty() ? names_ : words(given)) {
      order.push_back(static_cast<std::size_t>(std::find(names_.begin(), names_.end(), name) - names_.begin()));
    }
    std::vector<std::size_t> sorted = order;
    std::sort(sorted.begin(), sorted.end());
    bool each_once = sorted.size() == names_.size();
    for (std::size_t i = 0; each_once && i < sorted.size(); ++i) each_once = sorted[i] == i;
    std::vector<std::string> different = names_;
    std::sort(different.begin(), different.end());
    const bool named_twice = std::adjacent_find(different.begin(), different.end()) != different.end();
    if (!each_once || named_twice) {
      why = "parameter chain must name each joint of the parameter joints once, from the part to the tool";
    }
    return order;
  }

  [[nodiscard]] Frame interface_frame(std::string& why) const {
    const std::span<const double> numbers = sdk::find_numbers(parameters_, "interface");
    Frame frame;
    if (numbers.empty()) return frame;
    std::copy_n(numbers.begin(), std::min(numbers.size(), frame.p.size()), frame.p.begin());
    if (numbers.size() == 7) std::copy_n(numbers.begin() + 3, 4, frame.q.begin());
    if ((numbers.size() != 3 && numbers.size() != 7) || !check_frame(frame, "interface")) {
      why =
          "parameter interface must be the place of the tool interface in mm (3 numbers), or its place and unit "
          "quaternion w x y z (7 numbers)";
    }
    return normalized(frame);
  }

  void check_known(std::string& why) const {
    for (const sdk::Parameter& parameter : parameters_) {
      const std::string name = parameter.name;
      const bool is_joint = std::find(names_.begin(), names_.end(), name) != names_.end();
      if (is_joint || name == "joints" || name == "chain" || name == "interface") continue;
      why = "parameter \"" + name +
            "\" is not understood; there are joints, chain, interface, and one of each joint's name";
    }
  }

  sdk::Parameters parameters_;
  std::vector<std::string> names_;
};

/// Makes a chain; `kNames` are the joints where the parameter `joints` is not given: none, or some of X Y Z.
template <char... kNames>
struct ChainKinematicsFactory {
  static Kinematics* create(sdk::Parameters parameters, char* error, std::size_t error_size) noexcept {
    static constexpr char kDefault[] = {kNames..., '\0'};
    std::string joints;
    for (const char name : std::string_view(kDefault)) joints += {name, ' '};
    std::string why;
    Kinematics* const made = ChainReader(parameters, joints).make(why);
    if (made == nullptr) std::snprintf(error, error_size, "%s", why.c_str());
    return made;
  }
};

}  // namespace rmac::modules
