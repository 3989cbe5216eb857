#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "device_tree.hpp"
#include "places.hpp"
#include "rmac/motion/frame.hpp"
#include "rmac/motion/ports/kinematics.hpp"
#include "rows.hpp"

namespace rmac::bench {
namespace {

using Json = nlohmann::json;

struct Worst {
  double tip_mm = 0, axis_rad = 0, joints = 0;
  int unsolved = 0;
};

Worst round_trips(const Kinematics& kinematics, const Json& joints, int poses) {
  Worst worst;
  std::mt19937_64 random(20261121);
  const std::size_t n = joints.size();
  std::vector<double> q(n), seed(n), found(n), all(16 * n);
  for (int i = 0; i < poses; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      const double min = joints[j].value("Min", -720.0), max = joints[j].value("Max", 720.0);
      q[j] = std::uniform_real_distribution<double>(min, max)(random);
      seed[j] = q[j] + std::uniform_real_distribution<double>(-0.5, 0.5)(random);
    }
    const double length = std::uniform_real_distribution<double>(0, 150)(random);
    const Frame tool{{0, 0, -length}, {1, 0, 0, 0}};
    ToolPose pose, again;
    kinematics.forward(q, tool, pose);
    // Near the pole the seed's own branch may not be the nearest, so all solutions are asked for.
    const std::size_t count = kinematics.solutions(pose, tool, seed, all);
    double nearest = 1e30;
    for (std::size_t s = 0; s < count; ++s) {
      double off = 0;
      for (std::size_t j = 0; j < n; ++j) {
        const double by = all[s * n + j] - q[j];
        off = std::max(off, std::abs(kinematics.joint_type(j) == JointType::Rotary ? std::remainder(by, 360) : by));
      }
      nearest = std::min(nearest, off);
    }
    if (count == 0 || kinematics.inverse(pose, tool, seed, found) != KinematicsStatus::Ok) {
      ++worst.unsolved;
      continue;
    }
    kinematics.forward(found, tool, again);
    double tip = 0, axis = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      tip += (again.tip[c] - pose.tip[c]) * (again.tip[c] - pose.tip[c]);
      axis += (again.axis[c] - pose.axis[c]) * (again.axis[c] - pose.axis[c]);
    }
    worst.tip_mm = std::max(worst.tip_mm, std::sqrt(tip));
    worst.axis_rad = std::max(worst.axis_rad, std::sqrt(axis));
    worst.joints = std::max(worst.joints, nearest);
  }
  return worst;
}

}  // namespace

void inverse_rows(Figures& figures, int poses) {
  const std::filesystem::path tree = RMAC_SOURCE_DIR "/drivers";
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(tree)) {
    if (entry.path().filename() == "device.json") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  for (const auto& file : files) {
    const Json device = Json::parse(std::ifstream(file));
    const auto kinematics = kinematics_of(device, std::filesystem::relative(file.parent_path(), tree));
    const std::string row = "inverse_" + device["MechanismName"].get<std::string>();
    if (!kinematics) {
      figures.missing(row, "<= 1e-09", "mm", kinematics.error());
      continue;
    }
    const Worst worst = round_trips(**kinematics, device["Joints"], poses);
    const std::string cases = std::to_string(poses) + " poses";
    figures.at_most(row + "_tip", worst.tip_mm, 1e-9, "mm", cases);
    figures.at_most(row + "_axis", worst.axis_rad, 1e-9, "rad", cases);
    figures.at_most(row + "_unsolved", worst.unsolved, 0, "poses", cases);
    figures.inform(row + "_joints", worst.joints, "mm or deg", "worst of the joints the poses were made of");
  }
}

}  // namespace rmac::bench
