#include "device_tree.hpp"

#include <fstream>
#include <vector>

#include "conformance/loaded_module.hpp"
#include "places.hpp"

namespace rmac::bench {
namespace {

using Json = nlohmann::json;

constexpr double kSecondsPerMinute = 60;

/// Kinematics, and the module that holds its code.
struct Loaded {
  Loaded(const std::string& folder, const std::string& name) : module(folder, name) {}
  conformance::LoadedModule module;
  std::shared_ptr<Kinematics> kinematics;
};

JointLimits limits_of(const Json& joint) {
  JointLimits limits;
  limits.name = joint["Name"];
  limits.type = joint["Type"] == "Rotary" ? JointType::Rotary : JointType::Linear;
  limits.limit_type = joint["LimitType"] == "Infinite" ? JointLimitType::Infinite : JointLimitType::Limited;
  limits.min = joint.value("Min", 0.0);
  limits.max = joint.value("Max", 0.0);
  limits.max_speed = joint["MaxSpeed"];
  limits.max_acceleration = joint["MaxAcceleration"];
  limits.max_jerk = joint["MaxJerk"];
  return limits;
}

}  // namespace

tl::expected<std::shared_ptr<const Kinematics>, std::string> kinematics_of(const Json& device,
                                                                           const std::string& folder) {
  const std::string name = device["Kinematics"]["Module"];
  auto loaded = std::make_shared<Loaded>(folder, name);
  if (loaded->module.descriptor() == nullptr) loaded = std::make_shared<Loaded>("modules", name);
  const Json given = device["Kinematics"].value("Parameters", Json::object());
  std::vector<std::string> names, texts;
  std::vector<std::vector<double>> numbers;
  for (const auto& [key, value] : given.items()) {
    names.push_back(key);
    texts.push_back(value.is_string() ? value.get<std::string>() : "");
    numbers.push_back(value.is_array() ? value.get<std::vector<double>>() : std::vector<double>());
  }
  std::vector<sdk::Parameter> parameters;
  for (std::size_t i = 0; i < names.size(); ++i) {
    parameters.push_back({names[i].c_str(), numbers[i], texts[i].empty() ? nullptr : texts[i].c_str()});
  }
  loaded->kinematics = loaded->module.create<Kinematics>(parameters);
  if (!loaded->kinematics) return tl::unexpected(loaded->module.error());
  const Kinematics* const kinematics = loaded->kinematics.get();
  return std::shared_ptr<const Kinematics>(std::move(loaded), kinematics);
}

tl::expected<PlannerModel, std::string> model_of(const std::string& folder) {
  std::ifstream file(std::string(RMAC_SOURCE_DIR "/drivers/") + folder + "/device.json");
  const Json device = Json::parse(file, nullptr, false);
  if (device.is_discarded()) return tl::unexpected("no device.json in " + folder);
  return kinematics_of(device, folder).map([&](const std::shared_ptr<const Kinematics>& kinematics) {
    PlannerModel model;
    model.kinematics = kinematics;
    for (const Json& joint : device["Joints"]) model.joints.push_back(limits_of(joint));
    model.max_feed_mm_s = device["MaxFeedrate"].get<double>() / kSecondsPerMinute;
    return model;
  });
}

}  // namespace rmac::bench
