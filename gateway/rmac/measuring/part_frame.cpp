#include "gateway/rmac/measuring/part_frame.hpp"

#include "gateway/api/decode.hpp"

namespace rmac::cli {

Result<Frame> read_part_frame(Connection& connection) {
  return connection.call("RMAC_CAM.GetPartFrame").map([](const nlohmann::json& answer) {
    Frame frame;
    answer.at("p").get_to(frame.p);
    answer.at("q").get_to(frame.q);
    return frame;
  });
}

Result<> set_part_frame(Connection& connection, const Frame& frame) {
  return connection.command("RMAC_CAM.SetPartFrame", {{"PartFrame", gateway::frame_to_json(frame)}});
}

}  // namespace rmac::cli
