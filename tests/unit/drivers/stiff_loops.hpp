#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace rmac::mill_test {

/// PID for the axes of DMACXYZ as if they were rigid, with a sensitivity peak of about 2.1: Kp = 44.8 m, Ki = 90 Kp,
/// Kd = 0.32 m. What device.json has is for the axes that it describes, which bend.
inline void choose_stiff_loops(nlohmann::json& device) {
  static const std::map<std::string, std::vector<double>> kGains{
      {"X", {1550, 140000, 11.1}}, {"Y", {1820, 164000, 13.0}}, {"Z", {1195, 107500, 8.5}}};
  for (const char* list : {"Joints", "HeldJoints"}) {
    for (nlohmann::json& joint : device[list]) {
      nlohmann::json parameters = {{"rest_band", {0.002}}};
      if (joint["Name"] == "Z") parameters["load"] = {117.7};
      joint["ServoControlLaw"] = {{"Module", "DMAC_PID_CONTROL"}, {"Parameters", parameters}};
      joint["Gains"] = kGains.at(joint["Name"]);
    }
  }
}

}  // namespace rmac::mill_test
