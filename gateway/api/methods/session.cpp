// Methods that concern the connection rather than the machine.
#include "gateway/api/method_builder.hpp"
#include "gateway/api/methods/method_table.hpp"
#include "gateway/api/methods/openrpc.hpp"

namespace rmac::gateway {

void add_session_methods(std::vector<Method>& table) {
  const auto add = [&](Method entry) { table.push_back(std::move(entry)); };
  add(method("hello",
             "Tells who calls, and asks who answers: name, version, units and limits. Optional, and good manners.")
          .takes(text("client"), text("version").optional())
          .gives(WireType::Object)
          .extension()
          .does([](Call& call, const std::string& client, const std::optional<std::string>& version) {
            call.session.introduce(client, version.value_or(""));
            return call.session.greeting();
          }));
  add(method(
          "authority.acquire",
          "Takes motion authority, the lease that moving needs; one client at a time holds it. Gives `timeout_s`, the "
          "silence after which the lease ends (0: never), and `dropped_moves`, how many moves were dropped from the "
          "queue when the lease before it ended.")
          .gives(WireType::Object)
          .extension()
          .does([](Call& call) { return call.session.acquire_authority(); }));
  add(method("authority.renew",
             "Confirms that this connection still holds motion authority; like any request, it keeps the lease from "
             "ending.")
          .gives(WireType::Boolean)
          .extension()
          .does([](Call& call) { return call.session.renew_authority(); }));
  add(method("authority.release",
             "Gives motion authority back. As when a lease is lost, a machine that moves is stopped, and what is "
             "queued is "
             "dropped.")
          .gives(WireType::Boolean)
          .causes(Effect::Stops)
          .extension()
          .does([](Call& call) { return call.session.release_authority(); }));
  add(method("operator.acquire",
             "Takes the operator's place beside the holder of authority, or together with authority; one client at a "
             "time has it. Its holder may set the feed override, resume and retrace, and what it holds by FeedHold, or "
             "by an override of 0, only an operator resumes. Gives `name`, and `held_by`, who holds the machine as "
             "operator already, or empty.")
          .gives(WireType::Object)
          .extension()
          .does([](Call& call) {
            return call.session.acquire_operator().map([&](const std::string& name) {
              return nlohmann::json{{"name", name}, {"held_by", call.machine.cycle_now().held_by}};
            });
          }));
  add(method("operator.release",
             "Gives the operator's place up, as the end of its connection does. Nothing moves or stops by it; what is "
             "held stays held until the next operator resumes it, or the holder of authority after a Reset.")
          .gives(WireType::Boolean)
          .extension()
          .does([](Call& call) { return call.session.release_operator(); }));
  add(method("subscribe", "Pushes topics to this connection: state, joints, drives, animation, events.")
          .takes(texts("topics"),
                 number("rate_hz", "Hz").above(0).optional().noted("100 when left out; more for one client at a time"))
          .gives(WireType::Boolean)
          .extension()
          .does([](Call& call, const std::vector<std::string>& topics, std::optional<double> rate) {
            return call.session.subscribe(topics, rate.value_or(100));
          }));
  add(method("unsubscribe", "Ends the pushing of topics; of all when none is named.")
          .takes(texts("topics").optional())
          .gives(WireType::Boolean)
          .extension()
          .does([](Call& call, const std::optional<std::vector<std::string>>& topics) {
            call.session.unsubscribe(topics.value_or(std::vector<std::string>{}));
            return true;
          }));
  add(method("rpc.discover", "This API as an OpenRPC document.").gives(WireType::Object).extension().does([](Call&) {
    return openrpc_document();
  }));
}

}  // namespace rmac::gateway
