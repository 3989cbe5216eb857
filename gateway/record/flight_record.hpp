#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "gateway/state/cycle_sample.hpp"
#include "rmac/motion/drive_scale.hpp"
#include "rmac/motion/error.hpp"
#include "rmac/motion/joint_mechanics.hpp"
#include "rmac/motion/servo/cogging.hpp"

namespace rmac::gateway {

/// Why a flight record was written.
enum class FlightCause : std::uint8_t { Fault, Demand };

/// What a flight record says of itself.
struct FlightHead {
  struct Joint {
    std::string name, unit;
    std::string law;  ///< module of the servo law
    std::vector<double> gains;
    std::map<std::string, std::vector<double>> parameters;  ///< those of the law, by name
    double max_speed = 0, max_acceleration = 0, max_effort = 0;
    std::vector<Resonance> resonances;  ///< notches behind the law
    double low_pass_hz = 0;             ///< behind the law; 0: none
    int answer_delay = 0;               ///< so many cycles before was it where it is told to be
  };
  std::string name;
  FlightCause cause = FlightCause::Demand;
  std::string message;     ///< what happened, for a person
  std::int64_t cycle = 0;  ///< in which it happened, or up to which was asked for
  double t_s = 0;
  std::string utc;  ///< the same by the calendar
  std::string mechanism;
  std::vector<Joint> joints;  ///< held ones last, as in the columns
  struct Actuator {
    DriveScale scale;
    Cogging cogging;  ///< that is taken away
  };
  std::vector<Actuator> actuators;
  nlohmann::json buses;  ///< what the buses had gone through by then, as `Bus.GetState` tells it; null: not known
  std::int64_t first_cycle = 0, last_cycle = 0;
};

[[nodiscard]] nlohmann::json to_json(const FlightHead& head);

/// Writes a flight record: the head as one line of JSON, then the samples as a setpoint record with more columns
/// (docs/flight-recorder.md). The file appears whole under its name, or not at all. The samples are of one mechanism.
[[nodiscard]] Expected<> write_flight_record(const std::filesystem::path& file, const FlightHead& head,
                                             std::span<const CycleSample> samples);

/// The folder of the flight records.
class FlightFolder {
 public:
  explicit FlightFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// A name that sorts by time. Records of the two causes are told apart by it.
  [[nodiscard]] static std::string name_for(FlightCause cause, std::int64_t cycle,
                                            std::chrono::system_clock::time_point now);
  [[nodiscard]] std::filesystem::path file_of(const std::string& name) const;

  /// Heads of all records, oldest first, each with `bytes`, the size of its text, and without `buses`, which is long.
  /// What cannot be read is left out.
  [[nodiscard]] nlohmann::json list() const;

  /// A part of a record's text, from a byte on: `text`, `next_offset` (null at the end) and `bytes`, the whole size.
  [[nodiscard]] Expected<nlohmann::json> read(const std::string& name, std::int64_t offset) const;

  /// Removes all but the newest `kept` records of a cause.
  void prune(FlightCause cause, std::size_t kept) const noexcept;
  /// Removes what a daemon that died left half written.
  void remove_unfinished() const noexcept;

 private:
  /// Names of all records, oldest first.
  [[nodiscard]] std::vector<std::string> names() const;
  std::filesystem::path folder_;
};

}  // namespace rmac::gateway
