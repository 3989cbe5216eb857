// RMAC_CAM.*: what stands on the table, and the check of the path against it.
#include "gateway/api/method_builder.hpp"
#include "gateway/api/methods/method_table.hpp"

namespace rmac::gateway {

void add_guard_methods(std::vector<Method>& table) {
  const auto add = [&](Method entry) { table.push_back(std::move(entry)); };
  add(method(
          "RMAC_CAM.SetSetup",
          "Says what stands on the table: stock, part and fixtures, for SetCollisionCheck. All of it is in force, or "
          "nothing of it. Needs rest and an empty queue; loading or unloading a machine drops it.")
          .takes(object("Setup").or_null().noted(
              "as setup.json, but for meshes, which have Points and Triangles instead of a File; null, or left out: "
              "nothing stands there, and the check is switched off"))
          .needs(Permission::Authority)
          .may_be_slow()
          .extension()
          .does([](Call& call, const std::optional<JsonValue>& setup) {
            return call.machine.guard().set_setup(setup ? setup->json : nlohmann::json());
          }));
  add(method("RMAC_CAM.GetSetup", "What SetSetup set, as it was sent; empty: nothing is known of the table.")
          .gives(WireType::Object)
          .extension()
          .does([](Call& call) { return call.machine.guard().setup(); }));
  add(method(
          "RMAC_CAM.SetCollisionCheck",
          "Switches the check of the path against the machine's bodies and the set-up on or off; off at first. While "
          "it is on nothing is planned that was not checked: the machine comes to rest before bodies come nearer to "
          "each other than the set-up's Clearance, and the event CollisionAhead says which. Needs rest and an empty "
          "queue.")
          .takes(boolean("On"))
          .needs(Permission::Authority)
          .may_be_slow()
          .extension()
          .does([](Call& call, bool on) { return call.machine.guard().set_check(on); }));
  add(method("RMAC_CAM.GetCollisionCheck", "Whether what moves is checked before it does.")
          .gives(WireType::Boolean)
          .extension()
          .does([](Call& call) { return call.machine.guard().checks(); }));
}

}  // namespace rmac::gateway
