#include "gateway/rmac/commands/commission/tuning_laws.hpp"

#include <fmt/format.h>

#include "gateway/rmac/wire/requests.hpp"
#include "gateway/rmac/wire/rest.hpp"

namespace rmac::cli {

namespace {

using Json = nlohmann::json;

constexpr const char* kFeedforwardFeedback = "DMAC_FEEDFORWARDFEEDBACK_CONTROL";

/// Into the draft; nothing where several motors share the joint.
Result<> put_cogging(Connection& connection, const Json& motor, const char* which) {
  if (motor.is_null()) return {};
  Json actuators = Json::array();
  for (int i = 0; i < motor["of"].get<int>(); ++i) actuators.push_back(Json::object());
  actuators[motor["actuator"].get<std::size_t>()]["Cogging"] = motor[which];
  return connection.command("RMAC_Config.SetMechanismNumActuators",
                            {{"NumActuators", motor["of"]}, {"Buses", actuators}});
}

/// The law with feedforward and all that creeping has shown, with its motor's cogging.
Result<> put_model(Connection& connection, int joint, const Json& found) {
  return put_cogging(connection, found["creep"]["motor"], "cogging").and_then([&] {
    return put_law(connection, joint, kFeedforwardFeedback, found["creep"]["parameters"],
                   found["feedforward_feedback_gains"]);
  });
}

/// The law that was in force, behind its filters: as much of it as is taken.
Result<> put_back_law(Connection& connection, int joint, const Json& found) {
  const Json& filters = found["filters_in_force"];
  const Result<> set = filters.is_object() ? set_filters(connection, joint, filters) : Result<>();
  const Result<> put = put_law(connection, joint, found["law"], found["parameters"], found["gains"]);
  return set ? put : set;
}

/// Gains, and of a law that knows its axis the lead, in which the filters' delay is.
Result<> put_gains(Connection& connection, int joint, const Json& found) {
  return connection
      .command("RMAC_Config.SetMechanismJointServoControlGains",
               {{"JntNum", joint}, {"ServoControlGains", found["apply"]}})
      .and_then([&]() -> Result<> {
        if (!found["parameters"].contains("lead_s")) return {};
        return connection.command("RMAC_Config.SetMechanismJointServoControlParameter",
                                  {{"JntNum", joint}, {"Name", "lead_s"}, {"Value", found["lead_s"]}});
      })
      .and_then([&] { return connection.command("RMAC_Config.Apply"); });
}

}  // namespace

Result<> put_law(Connection& connection, int joint, const std::string& law, const Json& parameters, const Json& gains) {
  return connection
      .command("RMAC_Config.SetMechanismJointServoControlLaw",
               {{"JntNum", joint}, {"ControlLaw", law}, {"Parameters", parameters}})
      .and_then([&] {
        return connection.command("RMAC_Config.SetMechanismJointServoControlGains",
                                  {{"JntNum", joint}, {"ServoControlGains", gains}});
      })
      .and_then([&] { return connection.command("RMAC_Config.Apply"); });
}

Result<> set_filters(Connection& connection, int joint, const Json& filters) {
  return connection.command(
      "RMAC_Config.SetMechanismJointFilters",
      {{"JntNum", joint}, {"Resonances", filters["Resonances"]}, {"LowPass", filters["LowPass"]}});
}

Result<> under_law(Connection& connection, int joint, const Json& found, const std::function<Result<>()>& put,
                   const std::function<Result<>()>& work) {
  const Result<> worked = put().and_then(work);
  // No law is put in force before the machine rests; what stopped it is what is told.
  if (!worked)
    static_cast<void>(
        stop_now(connection).and_then([&] { return wait_for_rest(connection, "").map([](const StateNote&) {}); }));
  const Result<> put_back = put_back_law(connection, joint, found);
  if (put_back || worked) return worked ? put_back : worked;
  return fail(
      fmt::format("{}; and the law that was in force is not back ({}): `rmac load` brings the machine's own back",
                  worked.error().message, put_back.error().message));
}

Result<> put_proposed(Connection& connection, int joint, const Json& found) {
  Json parameters{{"load", found["load_known"]}};
  for (const char* kept : {"derivative_filter_s", "rest_band"}) {
    if (found["parameters"].contains(kept)) parameters[kept] = found["parameters"][kept];
  }
  return set_filters(connection, joint, found["proposed"]["filters"]).and_then([&] {
    return put_law(connection, joint, "PIDServoControlLaw", parameters, found["pid_gains"]);
  });
}

Result<> apply_found(Connection& connection, int joint, const Json& found) {
  const bool crept = !found["creep"].is_null();
  const Json& filters = found["proposed"]["filters"];
  const Result<> set = filters == found["filters_in_force"] ? Result<>() : set_filters(connection, joint, filters);
  const Result<> applied =
      set.and_then([&] { return crept ? put_model(connection, joint, found) : put_gains(connection, joint, found); });
  if (applied) return {};
  // Half of it would come in force with whatever is applied next.
  if (crept) static_cast<void>(put_cogging(connection, found["creep"]["motor"], "cogging_in_force"));
  static_cast<void>(put_back_law(connection, joint, found));
  return applied;
}

}  // namespace rmac::cli
