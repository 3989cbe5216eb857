#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gateway/rmac/connection.hpp"
#include "gateway/rmac/failure.hpp"
#include "gateway/rmac/runner.hpp"

namespace rmac::cli {

/// What `rmac machines` looks for. Numbers are lower bounds, in the units of the database.
struct MachineSearch {
  std::string type, configuration;
  std::optional<int> joints;
  std::string volume;  ///< LxWxD, mm
  std::optional<double> spindle_hp;
  std::string sql;                    ///< instead of all of the above
  std::string program;                ///< what they shall machine, a .rmac file; empty: nothing
  std::filesystem::path device_tree;  ///< in which they are simulated; empty: the installation's
  std::filesystem::path tools;        ///< folder of their tool tables then; empty: no tools but the program's own
};

/// Each command of the client: does its work, prints, and says why it could not. `json` prints for programs.
[[nodiscard]] Result<> list_machines(Connection& connection, const MachineSearch& search, bool json);
/// Draws what a machine of a device tree reaches; an empty tree: the installation's.
[[nodiscard]] Result<> plot_machine(const std::string& name, const std::string& picture,
                                    const std::filesystem::path& device_tree);
[[nodiscard]] Result<> show_machine(Connection& connection, const std::string& name, bool json);
[[nodiscard]] Result<> load_machine(Connection& connection, const std::string& name, bool virtual_mode);
[[nodiscard]] Result<> unload_machine(Connection& connection);

/// Whether a machine is named by its files instead of by its name in the database.
[[nodiscard]] bool is_path(const std::string& machine);
/// Has the appliance verify a machine of its device tree, and shows the report; fails when the machine is refused.
[[nodiscard]] Result<> verify_machine(Connection& connection, const std::string& name, bool json);
/// The same with a device.json, or the folder that holds it, and no appliance. Modules that are not beside it are
/// looked for among the shared ones of the device tree, which is the installation's when it is empty.
[[nodiscard]] Result<> verify_files(const std::string& path, const std::filesystem::path& device_tree, bool json);

[[nodiscard]] Result<> run_program(Connection& connection, const std::string& file, const RunOptions& options,
                                   bool json);

struct SimulateOptions {
  std::string machine;                ///< a name in the device tree, or the path of a device.json; empty: the program's
  std::filesystem::path device_tree;  ///< empty: the installation's
  std::string record_file;            ///< empty: none
  std::filesystem::path tools;        ///< folder of tool tables; empty: no tools but the program's own
  double period_s = 0.001;
};

/// Plans a program as the appliance would, without one, and tells how long it takes and what it asks of the machine.
[[nodiscard]] Result<> simulate_program(const std::string& file, const SimulateOptions& options, bool json);

[[nodiscard]] Result<> show_status(Connection& connection, bool watch, bool json);
/// Where the servo thread's time goes, as a table and bars.
[[nodiscard]] Result<> show_cycles(Connection& connection, bool json);
[[nodiscard]] Result<> show_events(Connection& connection, bool json);

/// What `rmac jog` moves: one joint, or the tool tip along a direction; by a distance, or at a velocity until Ctrl-C.
struct JogRequest {
  std::optional<int> joint;
  std::vector<double> direction;
  bool in_tool_frame = false;
  std::optional<double> distance, velocity;
};
[[nodiscard]] Result<> jog(Connection& connection, const JogRequest& request);
[[nodiscard]] Result<> home(Connection& connection);
[[nodiscard]] Result<> hold(Connection& connection);
[[nodiscard]] Result<> resume(Connection& connection);
[[nodiscard]] Result<> stop(Connection& connection);
/// Leaves a fault or an emergency stop whose cause is gone.
[[nodiscard]] Result<> reset(Connection& connection);
/// The program that is parked; with `back_from_mm`, goes back to its place first, from so far above it along the tool.
[[nodiscard]] Result<> show_parked(Connection& connection, std::optional<double> back_from_mm, bool json);
[[nodiscard]] Result<> set_override(Connection& connection, double percent);

/// The tool table of the loaded mechanism, and what is in the spindle.
[[nodiscard]] Result<> list_tools(Connection& connection, bool json);
/// A tool of the table as it is to be; of a tool that is there, what is not given stays.
struct ToolRequest {
  int number = 1;
  std::optional<double> length_mm, radius_mm, max_rpm, max_torque_nm;
  std::optional<std::string> name;
  std::optional<bool> needs_spindle;
  std::vector<double> frame;  ///< x y z, and the quaternion w x y z; empty: not given
};
[[nodiscard]] Result<> set_tool(Connection& connection, const ToolRequest& request);
[[nodiscard]] Result<> remove_tool(Connection& connection, int number);
/// Says that a tool is in the spindle; without a number, the one that was asked for.
[[nodiscard]] Result<> confirm_tool(Connection& connection, std::optional<int> number);

struct MeasureRequest {
  std::string plan;      ///< file
  bool apply = false;    ///< put the frame of the part as it was measured in force
  bool upright = false;  ///< a frame that is not tilted against the tool
};
/// Measures the points of a plan, and tells how far the part and its features are off.
[[nodiscard]] Result<> measure(Connection& connection, const MeasureRequest& request, bool json);

/// A reference sphere, and the probe that touches it. Part frame, mm.
struct QualifyRequest {
  std::vector<double> sphere;           ///< its centre and its radius
  std::optional<double> tip_radius_mm;  ///< about; none: that of the tool in the spindle
  double clearance_mm = 5;
  double speed_mm_s = 20;
  bool apply = false;  ///< correct the tool in the spindle
};
/// Touches a sphere that is known, and tells the radius of the probe's tip and how far its centre is off.
[[nodiscard]] Result<> qualify(Connection& connection, const QualifyRequest& request, bool json);

/// What `rmac tune` moves, and what it aims at.
struct TuneRequest {
  int joint = 0;
  double travel = 0;        ///< mm or deg from where the joint stands, signed; it comes back
  double bandwidth_hz = 0;  ///< 0: nine tenths of what the delay lets it have
  double phase_margin_deg = 40;
  std::string picture;  ///< empty: tune-JOINT.png here
  bool apply = false;
};
/// Finds what a joint is made of by moving it, and proposes gains. Changes nothing unless told to.
[[nodiscard]] Result<> tune(Connection& connection, const TuneRequest& request, bool json);

/// A circle from where the tool stands, upwards in Y.
struct FollowingRequest {
  double radius_mm = 25;
  double feed_mm_min = 0;  ///< 0: the machine's largest
  std::string picture;     ///< empty: following.png here
};
/// The circle test of ISO 230-4, as the drives' encoders show it.
[[nodiscard]] Result<> measure_following(Connection& connection, const FollowingRequest& request, bool json);

/// The flight records that there are.
[[nodiscard]] Result<> list_records(Connection& connection, bool json);
/// Has one written, and waits for it.
[[nodiscard]] Result<> make_record(Connection& connection, bool json);
/// Writes a record's cycles as CSV; an empty name: the newest one; an empty file: its name with .csv in this folder; -:
/// standard output.
[[nodiscard]] Result<> export_record(Connection& connection, const std::string& name, const std::string& file);
/// Draws a record: positions, following errors, efforts and states over time, with the cycle of the fault marked.
[[nodiscard]] Result<> plot_record(Connection& connection, const std::string& name, const std::string& file);

/// The bits that a machine's CAN buses carry at worst in a cycle of `period_s`, from its device.json alone; fails when
/// a bus exceeds its share. Needs no appliance.
[[nodiscard]] Result<> show_bus_load(const std::string& device_json, double period_s, bool json);

/// A first motion of one CANopen drive by itself, on a bus that no machine runs.
struct DriveMove {
  std::string interface, mode, setup;
  int node = 0;
  std::int32_t amount = 0;
  double seconds = 1;
  std::int64_t within = 0;
};
[[nodiscard]] Result<> move_drive(const DriveMove& move);
/// Names of the modes that it can be by.
[[nodiscard]] std::vector<std::string> trial_modes();

/// Layer setting services: the nodes without an id; a node id for one of them, or for the node of an identity (vendor,
/// product, revision and serial number); a bit rate for all. Each refuses a bus on which a machine runs.
[[nodiscard]] Result<> lss_scan(const std::string& interface, bool json);
struct LssAssignment {
  std::string interface;
  int node = 0;
  std::vector<std::uint32_t> identity;  ///< four numbers, or none
};
[[nodiscard]] Result<> lss_assign(const LssAssignment& wanted);
[[nodiscard]] Result<> lss_set_bit_rate(const std::string& interface, std::uint32_t bit_rate, double delay_s);

/// Lists the CANopen nodes on an interface, and which data sheets of `folder` are theirs; refuses a bus on which a
/// machine runs. Needs no appliance.
[[nodiscard]] Result<> scan_bus(const std::string& interface, const std::string& folder, bool json);

/// Has a node keep its parameters as they are now (1010h), or take the maker's from its next reset on (1011h).
[[nodiscard]] Result<> store_node(const std::string& interface, int node, bool defaults);

}  // namespace rmac::cli
