// RMAC_CAM.*: what was learned of a program that is repeated.
#include "gateway/api/method_builder.hpp"
#include "gateway/api/methods/method_table.hpp"

namespace rmac::gateway {

void add_learning_methods(std::vector<Method>& table) {
  const auto add = [&](Method entry) { table.push_back(std::move(entry)); };
  add(method(
          "RMAC_CAM.SetLearnedOffsets",
          "Has joints' servo laws make good what was learned of a program that is repeated, place by place on its "
          "path (docs/servo.md). Setpoints as they are told, watched and recorded stay the program's. Needs rest and "
          "an empty queue. Ends with motion authority, and when a machine is loaded, unloaded or configured.")
          .takes(object("Learned").or_null().noted(
              "as rmac run --learn writes it; null, or left out: nothing is made good any more"))
          .needs(Permission::Authority)
          .extension()
          .does([](Call& call, const std::optional<JsonValue>& learned) {
            return call.machine.learning().set_learned(learned ? learned->json : nlohmann::json());
          }));
  add(method("RMAC_CAM.GetLearnedOffsets",
             "What there is to know for who learns a program: Machine, Configuration (changes with gains, filters, "
             "limits, …), Virtual, Period (s), of each of the Joints its Name, LargestOffset (mm or deg; 0: its drive "
             "closes its loop itself) and AnswerDelay (cycles); and how many Moves and Knots are in force.")
          .gives(WireType::Object)
          .extension()
          .does([](Call& call) { return call.machine.learning().learned(); }));
}

}  // namespace rmac::gateway
