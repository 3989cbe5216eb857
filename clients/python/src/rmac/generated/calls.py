"""Written by clients/python/generate.py from rpc.discover; do not edit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, overload

from rmac.generated import enums, types
from rmac.wire.call import Call


class DeviceDriverManager:
    @staticmethod
    def OpenDeviceDriverDatabase() -> Call[bool]:
        """Opens this connection's record set with every mechanism in it, the first one current."""
        return Call("DeviceDriverManager.OpenDeviceDriverDatabase", {})

    @staticmethod
    def CloseDeviceDriverDatabase() -> Call[bool]:
        """Closes this connection's record set."""
        return Call("DeviceDriverManager.CloseDeviceDriverDatabase", {})

    @staticmethod
    def GetTotalNumberOfRecords() -> Call[int]:
        """Number of mechanisms in the device driver database."""
        return Call("DeviceDriverManager.GetTotalNumberOfRecords", {})

    @staticmethod
    def SearchDatabaseRecordSet(MachineSQLStatement: str) -> Call[int]:
        """Replaces the record set by the mechanisms that a SELECT on the table DeviceDrivers finds; gives their number. MachineSQLStatement: one read-only SELECT that yields MechanismID (or *), within 200 ms."""
        return Call("DeviceDriverManager.SearchDatabaseRecordSet", {"MachineSQLStatement": MachineSQLStatement})

    @staticmethod
    def GetDatabaseRecordSetColumns() -> Call[bool]:
        """Checks that the record set has a current row; the getters below read it."""
        return Call("DeviceDriverManager.GetDatabaseRecordSetColumns", {})

    @staticmethod
    def OnNextRecord() -> Call[None]:
        """Goes to the next row; on the last one an error."""
        return Call("DeviceDriverManager.OnNextRecord", {})

    @staticmethod
    def OnPreviousRecord() -> Call[None]:
        """Goes to the row before; on the first one an error."""
        return Call("DeviceDriverManager.OnPreviousRecord", {})

    @staticmethod
    def OnFirstRecord() -> Call[None]:
        """Goes to the first row."""
        return Call("DeviceDriverManager.OnFirstRecord", {})

    @staticmethod
    def OnLastRecord() -> Call[None]:
        """Goes to the last row."""
        return Call("DeviceDriverManager.OnLastRecord", {})

    @staticmethod
    def Machine_GetMechanismID() -> Call[int]:
        """Number of the mechanism in the database."""
        return Call("DeviceDriverManager.Machine_GetMechanismID", {})

    @staticmethod
    def Machine_GetMechanismName() -> Call[str]:
        """Name of the mechanism."""
        return Call("DeviceDriverManager.Machine_GetMechanismName", {})

    @staticmethod
    def Machine_GetMechanismDeviceDriver() -> Call[str]:
        """Name of its device driver."""
        return Call("DeviceDriverManager.Machine_GetMechanismDeviceDriver", {})

    @staticmethod
    def Machine_GetMechanismDeviceDriverVersion() -> Call[int]:
        """Version of its device driver, 1.2.3 as 10203."""
        return Call("DeviceDriverManager.Machine_GetMechanismDeviceDriverVersion", {})

    @staticmethod
    def Machine_GetMechanismType() -> Call[str]:
        """What kind of machine it is, e.g. Mill."""
        return Call("DeviceDriverManager.Machine_GetMechanismType", {})

    @staticmethod
    def Machine_GetMechanismConfigurationType() -> Call[str]:
        """Its arrangement, e.g. 3-axis."""
        return Call("DeviceDriverManager.Machine_GetMechanismConfigurationType", {})

    @staticmethod
    def Machine_GetMechanismNumberOfJoints() -> Call[int]:
        """Number of joints it moves."""
        return Call("DeviceDriverManager.Machine_GetMechanismNumberOfJoints", {})

    @staticmethod
    def Machine_GetMechanismWorkingVolume() -> Call[str]:
        """Length, width and depth of the working volume, as "100x100x100". Gives mm."""
        return Call("DeviceDriverManager.Machine_GetMechanismWorkingVolume", {})

    @staticmethod
    def Machine_GetMechanismSpindleHorsePower() -> Call[float]:
        """Power of its spindle. Gives hp."""
        return Call("DeviceDriverManager.Machine_GetMechanismSpindleHorsePower", {})

    @staticmethod
    def Machine_GetMechanismSpindleMaxSpeed() -> Call[float]:
        """Largest speed of its spindle. Gives rpm."""
        return Call("DeviceDriverManager.Machine_GetMechanismSpindleMaxSpeed", {})

    @staticmethod
    def Machine_GetMechanismSpindleMaxTorque() -> Call[float]:
        """Largest torque of its spindle. Gives N·m."""
        return Call("DeviceDriverManager.Machine_GetMechanismSpindleMaxTorque", {})

    @staticmethod
    def Machine_GetMechanismMaxFeedrate() -> Call[float]:
        """Largest feed. Gives mm/min."""
        return Call("DeviceDriverManager.Machine_GetMechanismMaxFeedrate", {})

    @staticmethod
    def Machine_GetMechanismMaxPalletLoad() -> Call[float]:
        """Largest load on its table. Gives kg."""
        return Call("DeviceDriverManager.Machine_GetMechanismMaxPalletLoad", {})

    @staticmethod
    def Machine_GetMechanismPositioningTolerance() -> Call[float]:
        """How exactly it reaches a position. Gives mm."""
        return Call("DeviceDriverManager.Machine_GetMechanismPositioningTolerance", {})

    @staticmethod
    def Machine_GetMechanismRepeatabilityTolerance() -> Call[float]:
        """How exactly it reaches it again. Gives mm."""
        return Call("DeviceDriverManager.Machine_GetMechanismRepeatabilityTolerance", {})

    @staticmethod
    def Rescan() -> Call[dict[str, Any]]:
        """Reads the device tree again. Gives `mechanisms`, how many are in the database after it, and `problems`, what was left out: `file` and `message` of each."""
        return Call("DeviceDriverManager.Rescan", {})


class Device:
    @staticmethod
    def Load(Name: str, Virtual: bool | None = None, Soften: float | None = None) -> Call[bool]:
        """Loads a mechanism's device driver and configures the controller by it, at standstill; on any failure the mechanism that was loaded stays. Modules that did not pass their verification before are verified first. Virtual: true: setpoints come back as joint values and no bus is touched; false when left out. Soften: for commissioning: Kp and Kd of its PIDs divided by this, Ki by its square, and a quarter of their accelerations; 1 when left out."""
        return Call("Device.Load", {"Name": Name, "Virtual": Virtual, "Soften": Soften})

    @staticmethod
    def Unload() -> Call[bool]:
        """Takes the mechanism out at standstill: drives off, no motion until another is loaded."""
        return Call("Device.Unload", {})

    @staticmethod
    def Verify(Name: str) -> Call[dict[str, Any]]:
        """Checks a mechanism's modules in a separate process. Gives the report: `ok`, and `modules`, of each the checks that it `passed`, what was `not_checked`, and the `counter_example` that refuses it."""
        return Call("Device.Verify", {"Name": Name})

    @staticmethod
    def GetModules() -> Call[dict[str, Any]]:
        """The modules that are in force, its device driver first. Gives `modules`: `role`, `module` and `build_id` of each."""
        return Call("Device.GetModules", {})

    @staticmethod
    def OpenDeviceDatabase() -> Call[bool]:
        """Has this connection read the loaded mechanism's database, as it does at first; an error where none is loaded."""
        return Call("Device.OpenDeviceDatabase", {})

    @staticmethod
    def CloseDeviceDatabase() -> Call[bool]:
        """Ends this connection's reading: the getters below refuse until it is opened again."""
        return Call("Device.CloseDeviceDatabase", {})

    @staticmethod
    def GetDatabaseRecordSetMechanismColumns() -> Call[bool]:
        """Checks that the mechanism's values are there; the getters below read them."""
        return Call("Device.GetDatabaseRecordSetMechanismColumns", {})

    @staticmethod
    def GetDatabaseRecordSetJointColumns(JntNum: int) -> Call[bool]:
        """Checks that this joint's values are there."""
        return Call("Device.GetDatabaseRecordSetJointColumns", {"JntNum": JntNum})

    @staticmethod
    def Machine_GetMechanismName() -> Call[str]:
        """Name of the loaded mechanism."""
        return Call("Device.Machine_GetMechanismName", {})

    @staticmethod
    def Machine_GetMechanismKinematics() -> Call[str]:
        """Module that computes its kinematics."""
        return Call("Device.Machine_GetMechanismKinematics", {})

    @staticmethod
    def Machine_GetMechanismActuatorMap() -> Call[str]:
        """Module that maps its joints to actuators."""
        return Call("Device.Machine_GetMechanismActuatorMap", {})

    @staticmethod
    def Machine_GetMechanismNumberOfJoints() -> Call[int]:
        """Number of joints it moves, without held ones."""
        return Call("Device.Machine_GetMechanismNumberOfJoints", {})

    @staticmethod
    def Machine_GetMechanismConfiguration() -> Call[str]:
        """Its arrangement, e.g. 3-axis."""
        return Call("Device.Machine_GetMechanismConfiguration", {})

    @staticmethod
    def Machine_GetMechanismWorkingVolume() -> Call[str]:
        """Length, width and depth of the working volume, as "100x100x100". Gives mm."""
        return Call("Device.Machine_GetMechanismWorkingVolume", {})

    @staticmethod
    def Machine_GetMechanismMaxFeedrate() -> Call[float]:
        """Largest feed. Gives mm/min."""
        return Call("Device.Machine_GetMechanismMaxFeedrate", {})

    @staticmethod
    def Machine_GetMechanismSpindleHorsePower() -> Call[float]:
        """Power of spindle 0; 0 without a spindle. Gives hp."""
        return Call("Device.Machine_GetMechanismSpindleHorsePower", {})

    @staticmethod
    def Machine_GetMechanismSpindleMaxSpeed() -> Call[float]:
        """Largest speed of spindle 0. Gives rpm."""
        return Call("Device.Machine_GetMechanismSpindleMaxSpeed", {})

    @staticmethod
    def Machine_GetMechanismSpindleMaxTorque() -> Call[float]:
        """Largest torque of spindle 0. Gives N·m."""
        return Call("Device.Machine_GetMechanismSpindleMaxTorque", {})

    @staticmethod
    def Machine_GetMechanismMaxPalletLoad() -> Call[float]:
        """Largest load on its table. Gives kg."""
        return Call("Device.Machine_GetMechanismMaxPalletLoad", {})

    @staticmethod
    def Machine_GetMechanismPositioningTolerance() -> Call[float]:
        """How exactly it reaches a position. Gives mm."""
        return Call("Device.Machine_GetMechanismPositioningTolerance", {})

    @staticmethod
    def Machine_GetMechanismRepeatabilityTolerance() -> Call[float]:
        """How exactly it reaches it again. Gives mm."""
        return Call("Device.Machine_GetMechanismRepeatabilityTolerance", {})

    @staticmethod
    def Machine_GetMechanismJntTypes(JntNum: int) -> Call[enums.JointType]:
        """Whether the joint turns or slides."""
        return Call("Device.Machine_GetMechanismJntTypes", {"JntNum": JntNum}, enums.JointType)

    @staticmethod
    def Machine_GetMechanismJntMaxLimit(JntNum: int) -> Call[float]:
        """Upper end of the joint's travel. Gives mm or deg."""
        return Call("Device.Machine_GetMechanismJntMaxLimit", {"JntNum": JntNum})

    @staticmethod
    def Machine_GetMechanismJntMinLimit(JntNum: int) -> Call[float]:
        """Lower end of the joint's travel. Gives mm or deg."""
        return Call("Device.Machine_GetMechanismJntMinLimit", {"JntNum": JntNum})

    @staticmethod
    def Machine_GetMechanismJntMaxSpeed(JntNum: int) -> Call[float]:
        """Largest speed of the joint. Gives mm/s or deg/s."""
        return Call("Device.Machine_GetMechanismJntMaxSpeed", {"JntNum": JntNum})

    @staticmethod
    def Machine_GetMechanismJntMaxAccel(JntNum: int) -> Call[float]:
        """Largest acceleration of the joint. Gives mm/s² or deg/s²."""
        return Call("Device.Machine_GetMechanismJntMaxAccel", {"JntNum": JntNum})

    @staticmethod
    def Machine_GetMechanismJntMaxJerk(JntNum: int) -> Call[float]:
        """Largest jerk of the joint. Gives mm/s³ or deg/s³."""
        return Call("Device.Machine_GetMechanismJntMaxJerk", {"JntNum": JntNum})

    @staticmethod
    def Machine_GetMechanismJntServoControlLaw(JntNum: int) -> Call[str]:
        """Module that holds the joint's servo law."""
        return Call("Device.Machine_GetMechanismJntServoControlLaw", {"JntNum": JntNum})

    @staticmethod
    def Machine_SetMechanismNumberOfJoints(NumJnts: int) -> Call[None]:
        """Wanted number of joints. Acts with the next Machine_ConfigureMotionPlanner, which refuses what modules do not fit."""
        return Call("Device.Machine_SetMechanismNumberOfJoints", {"NumJnts": NumJnts})

    @staticmethod
    def Machine_SetMechanismMaxFeedrate(MaxFeedrate: float) -> Call[None]:
        """Wanted largest feed. Acts with the next Machine_ConfigureMotionPlanner. MaxFeedrate: mm/min."""
        return Call("Device.Machine_SetMechanismMaxFeedrate", {"MaxFeedrate": MaxFeedrate})

    @staticmethod
    def Machine_SetMechanismSpindleMaxSpeed(MaxSpindleSpeed: float) -> Call[None]:
        """Wanted largest speed of spindle 0. Acts with the next Machine_ConfigureMotionPlanner. MaxSpindleSpeed: rpm."""
        return Call("Device.Machine_SetMechanismSpindleMaxSpeed", {"MaxSpindleSpeed": MaxSpindleSpeed})

    @staticmethod
    def Machine_SetMechanismSpindleMaxTorque(MaxSpindleTorque: float) -> Call[None]:
        """Wanted largest torque of spindle 0: its servo law gives no more, and measured it is an overload that stops the machine. Acts with the next Machine_ConfigureMotionPlanner. MaxSpindleTorque: N·m."""
        return Call("Device.Machine_SetMechanismSpindleMaxTorque", {"MaxSpindleTorque": MaxSpindleTorque})

    @staticmethod
    def Machine_SetMechanismJntTypes(JntNum: int, JntType: enums.JointType | int | str) -> Call[None]:
        """Wanted type of a joint. Acts with the next Machine_ConfigureMotionPlanner."""
        return Call("Device.Machine_SetMechanismJntTypes", {"JntNum": JntNum, "JntType": JntType})

    @staticmethod
    def Machine_SetMechanismJntMaxLimit(JntNum: int, MaxJntLimit: float) -> Call[None]:
        """Wanted upper end of a joint's travel. Acts with the next Machine_ConfigureMotionPlanner. MaxJntLimit: mm or deg."""
        return Call("Device.Machine_SetMechanismJntMaxLimit", {"JntNum": JntNum, "MaxJntLimit": MaxJntLimit})

    @staticmethod
    def Machine_SetMechanismJntMinLimit(JntNum: int, MinJntLimit: float) -> Call[None]:
        """Wanted lower end of a joint's travel. Acts with the next Machine_ConfigureMotionPlanner. MinJntLimit: mm or deg."""
        return Call("Device.Machine_SetMechanismJntMinLimit", {"JntNum": JntNum, "MinJntLimit": MinJntLimit})

    @staticmethod
    def Machine_SetMechanismJntMaxSpeed(JntNum: int, MaxJntSpeed: float) -> Call[None]:
        """Wanted largest speed of a joint. Acts with the next Machine_ConfigureMotionPlanner. MaxJntSpeed: mm/s or deg/s."""
        return Call("Device.Machine_SetMechanismJntMaxSpeed", {"JntNum": JntNum, "MaxJntSpeed": MaxJntSpeed})

    @staticmethod
    def Machine_SetMechanismJntMaxAccel(JntNum: int, MaxJntAccel: float) -> Call[None]:
        """Wanted largest acceleration of a joint. Acts with the next Machine_ConfigureMotionPlanner. MaxJntAccel: mm/s² or deg/s²."""
        return Call("Device.Machine_SetMechanismJntMaxAccel", {"JntNum": JntNum, "MaxJntAccel": MaxJntAccel})

    @staticmethod
    def Machine_SetMechanismJntMaxJerk(JntNum: int, MaxJntJerk: float) -> Call[None]:
        """Wanted largest jerk of a joint. Acts with the next Machine_ConfigureMotionPlanner. MaxJntJerk: mm/s³ or deg/s³."""
        return Call("Device.Machine_SetMechanismJntMaxJerk", {"JntNum": JntNum, "MaxJntJerk": MaxJntJerk})

    @staticmethod
    def Machine_ConfigureMotionPlanner() -> Call[bool]:
        """The driver configures the motion planner by the wanted values: joints, limits, largest feed and speeds, at standstill; or nothing changes."""
        return Call("Device.Machine_ConfigureMotionPlanner", {})

    @staticmethod
    def Machine_ConfigureServoController() -> Call[bool]:
        """The driver puts the database's control methods, servo laws, gains and bounds of the following error back in, at standstill, whatever RMAC_Config made of them; or nothing changes. What the setters ask for waits for Machine_ConfigureMotionPlanner."""
        return Call("Device.Machine_ConfigureServoController", {})

    @staticmethod
    def Machine_ConfigureDigitalControlInterface() -> Call[bool]:
        """The driver puts the database's interfaces to drives and I/O back in, at standstill, whatever RMAC_Config made of them; or nothing changes."""
        return Call("Device.Machine_ConfigureDigitalControlInterface", {})

    @staticmethod
    def Machine_MoveInNurbsND(MoveID: int, NurbsND: types.NurbsLike) -> Call[bool]:
        """Queues a NURBS in joint space or with a tool axis; evaluated exactly, never cut into lines. MoveID: the client's number; comes back in events and records. NurbsND: mm or deg."""
        return Call("Device.Machine_MoveInNurbsND", {"MoveID": MoveID, "NurbsND": NurbsND})

    @staticmethod
    def Machine_MoveInNurbs(MoveID: int, Nurbs: types.NurbsLike) -> Call[bool]:
        """Queues a NURBS of the tool tip; the axis stays as it is when it begins. MoveID: the client's number; comes back in events and records. Nurbs: mm."""
        return Call("Device.Machine_MoveInNurbs", {"MoveID": MoveID, "Nurbs": Nurbs})

    @staticmethod
    def Machine_MoveInArc3(MoveID: int, ViaPoint: types.Vector, StartPoint: types.FrameLike, EndPoint: types.FrameLike) -> Call[bool]:
        """Queues a circular arc through a point. MoveID: the client's number; comes back in events and records. ViaPoint: mm. StartPoint: mm. EndPoint: mm."""
        return Call("Device.Machine_MoveInArc3", {"MoveID": MoveID, "ViaPoint": ViaPoint, "StartPoint": StartPoint, "EndPoint": EndPoint})

    @staticmethod
    def Machine_MoveInArc(MoveID: int, RotSign: enums.RotSign | int | str, Closed: bool, CenterPoint: types.FrameLike, StartPoint: types.FrameLike, EndPoint: types.FrameLike, Turns: int | None = None) -> Call[bool]:
        """Queues a circular arc about the axis of CenterPoint; Closed makes it a full circle. Where EndPoint lies off its plane, along the axis, it is a helix of even pitch. MoveID: the client's number; comes back in events and records. CenterPoint: mm. StartPoint: mm. EndPoint: mm. Turns: whole turns more."""
        return Call("Device.Machine_MoveInArc", {"MoveID": MoveID, "RotSign": RotSign, "Closed": Closed, "CenterPoint": CenterPoint, "StartPoint": StartPoint, "EndPoint": EndPoint, "Turns": Turns})

    @staticmethod
    def Machine_MoveInLine(MoveID: int, StartPoint: types.FrameLike, EndPoint: types.FrameLike) -> Call[bool]:
        """Queues a straight line; the tool axis turns evenly along it. MoveID: the client's number; comes back in events and records. StartPoint: mm. EndPoint: mm."""
        return Call("Device.Machine_MoveInLine", {"MoveID": MoveID, "StartPoint": StartPoint, "EndPoint": EndPoint})

    @staticmethod
    def Machine_SetFeedrate(Feedrate: float) -> Call[None]:
        """Feed of the moves queued from now on; refused above the maximum. Feedrate: mm/min."""
        return Call("Device.Machine_SetFeedrate", {"Feedrate": Feedrate})

    @staticmethod
    def Machine_GetFeedrate() -> Call[float]:
        """Actual speed of the tool tip, from measured joints. Gives mm/min."""
        return Call("Device.Machine_GetFeedrate", {})


class RMAC_Config:
    @staticmethod
    def SetMechanismKinematics(DMACKin: str, Parameters: Mapping[str, Any] | None = None) -> Call[None]:
        """Module that computes the kinematics. DMACKin: name of a module. Parameters: its parameters, as in device.json; left out, a module that was chosen already keeps those it has, and another has none."""
        return Call("RMAC_Config.SetMechanismKinematics", {"DMACKin": DMACKin, "Parameters": Parameters})

    @staticmethod
    def SetMechanismActuatorMap(DMACMachineActMap: str, Parameters: Mapping[str, Any] | None = None) -> Call[None]:
        """Module that maps joints to actuators. DMACMachineActMap: name of a module. Parameters: its parameters, as in device.json; left out, a module that was chosen already keeps those it has, and another has none."""
        return Call("RMAC_Config.SetMechanismActuatorMap", {"DMACMachineActMap": DMACMachineActMap, "Parameters": Parameters})

    @staticmethod
    def SetMechanismNumJnts(NumJnts: int) -> Call[None]:
        """Number of joints that the mechanism moves. One that comes is as device.json has it, or waits for its setters."""
        return Call("RMAC_Config.SetMechanismNumJnts", {"NumJnts": NumJnts})

    @staticmethod
    def SetMechanismNumSpindle(NumSpindle: int, Buses: Sequence[Mapping[str, Any]] | None = None) -> Call[None]:
        """Number of spindles. Buses: for each its `Bus`, `Axis` and what else Spindles of device.json have (but for `Inputs`); what is left out stays as it is."""
        return Call("RMAC_Config.SetMechanismNumSpindle", {"NumSpindle": NumSpindle, "Buses": Buses})

    @staticmethod
    def SetMechanismNumActuators(NumActuators: int, Buses: Sequence[Mapping[str, Any]] | None = None) -> Call[None]:
        """Number of actuators behind joints and held joints. Buses: for each its `Bus`, `Axis` and what else Actuators of device.json have (but for `Inputs`); what is left out stays as it is."""
        return Call("RMAC_Config.SetMechanismNumActuators", {"NumActuators": NumActuators, "Buses": Buses})

    @staticmethod
    def SetMechanismMaxFeedrate(MaxFeedrate: float) -> Call[None]:
        """Largest feed of the mechanism. MaxFeedrate: mm/min."""
        return Call("RMAC_Config.SetMechanismMaxFeedrate", {"MaxFeedrate": MaxFeedrate})

    @staticmethod
    def SetMechanismJointName(JntNum: int, Name: str) -> Call[None]:
        """Name of a joint; every joint has one of its own."""
        return Call("RMAC_Config.SetMechanismJointName", {"JntNum": JntNum, "Name": Name})

    @staticmethod
    def SetMechanismJointType(JntNum: int, JointType: enums.JointType | int | str) -> Call[None]:
        """Whether a joint turns, slides or screws."""
        return Call("RMAC_Config.SetMechanismJointType", {"JntNum": JntNum, "JointType": JointType})

    @staticmethod
    def SetMechanismJointLimitType(JntNum: int, JointLimitType: enums.JointLimitType | int | str) -> Call[None]:
        """On which sides a joint's travel ends."""
        return Call("RMAC_Config.SetMechanismJointLimitType", {"JntNum": JntNum, "JointLimitType": JointLimitType})

    @staticmethod
    def SetMechanismJointMaximumLimit(JntNum: int, MaxJntLimit: float) -> Call[None]:
        """Upper end of a joint's travel. MaxJntLimit: mm or deg."""
        return Call("RMAC_Config.SetMechanismJointMaximumLimit", {"JntNum": JntNum, "MaxJntLimit": MaxJntLimit})

    @staticmethod
    def SetMechanismJointMinimumLimit(JntNum: int, MinJntLimit: float) -> Call[None]:
        """Lower end of a joint's travel. MinJntLimit: mm or deg."""
        return Call("RMAC_Config.SetMechanismJointMinimumLimit", {"JntNum": JntNum, "MinJntLimit": MinJntLimit})

    @staticmethod
    def SetMechanismJointMaximumSpeed(JntNum: int, MaxJntSpeed: float) -> Call[None]:
        """Largest speed of a joint. MaxJntSpeed: mm/s or deg/s."""
        return Call("RMAC_Config.SetMechanismJointMaximumSpeed", {"JntNum": JntNum, "MaxJntSpeed": MaxJntSpeed})

    @staticmethod
    def SetMechanismJointMaximumAcceleration(JntNum: int, MaxJntAccel: float) -> Call[None]:
        """Largest acceleration of a joint. MaxJntAccel: mm/s² or deg/s²."""
        return Call("RMAC_Config.SetMechanismJointMaximumAcceleration", {"JntNum": JntNum, "MaxJntAccel": MaxJntAccel})

    @staticmethod
    def SetMechanismJointMaximumJerk(JntNum: int, MaxJntJerk: float) -> Call[None]:
        """Largest jerk of a joint. MaxJntJerk: mm/s³ or deg/s³."""
        return Call("RMAC_Config.SetMechanismJointMaximumJerk", {"JntNum": JntNum, "MaxJntJerk": MaxJntJerk})

    @staticmethod
    def SetMechanismJointControlMethod(JntNum: int, DMACServoControlMethod: enums.ServoControlMethod | int | str) -> Call[None]:
        """What a joint's servo loop controls."""
        return Call("RMAC_Config.SetMechanismJointControlMethod", {"JntNum": JntNum, "DMACServoControlMethod": DMACServoControlMethod})

    @staticmethod
    def SetMechanismJointServoControlGains(JntNum: int, ServoControlGains: types.Numbers) -> Call[None]:
        """Gains of a joint's servo law, in the law's own order. ServoControlGains: as the law declares."""
        return Call("RMAC_Config.SetMechanismJointServoControlGains", {"JntNum": JntNum, "ServoControlGains": ServoControlGains})

    @staticmethod
    def SetMechanismJointServoControlLaw(JntNum: int, ControlLaw: str, Parameters: Mapping[str, Any] | None = None) -> Call[None]:
        """Servo law of a joint. ControlLaw: DMAC_PID_CONTROL or another constant of Appendix IV, or the name of a module. Parameters: its parameters, as in device.json; left out, a module that was chosen already keeps those it has, and another has none."""
        return Call("RMAC_Config.SetMechanismJointServoControlLaw", {"JntNum": JntNum, "ControlLaw": ControlLaw, "Parameters": Parameters})

    @staticmethod
    def SetMechanismJointWatch(JntNum: int, MaxFollowingError: float, MaxEffort: float) -> Call[None]:
        """How far a joint may fall behind, and how hard it may be driven, before the machine stops. MaxFollowingError: mm or deg. MaxEffort: N or N·m."""
        return Call("RMAC_Config.SetMechanismJointWatch", {"JntNum": JntNum, "MaxFollowingError": MaxFollowingError, "MaxEffort": MaxEffort})

    @staticmethod
    def SetMechanismJointServoControlParameter(JntNum: int, Name: str, Value: float) -> Call[None]:
        """A parameter of a joint's servo law beside its gains: lead_s, rest_band, … Another law forgets it. Name: as docs/servo.md has it. Value: as the law declares."""
        return Call("RMAC_Config.SetMechanismJointServoControlParameter", {"JntNum": JntNum, "Name": Name, "Value": Value})

    @staticmethod
    def SetMechanismJointFilters(JntNum: int, LowPass: float, Resonances: Sequence[Mapping[str, Any]]) -> Call[None]:
        """Filters of a joint's effort: a notch for each resonance, and a low-pass. They take the place of those that it has. LowPass: Hz; 0 for none. Resonances: as in device.json; [] for none."""
        return Call("RMAC_Config.SetMechanismJointFilters", {"JntNum": JntNum, "LowPass": LowPass, "Resonances": Resonances})

    @staticmethod
    def SetMechanismSpindleMaxRPM(MaxSpindleRPM: float) -> Call[None]:
        """Largest speed of every spindle. MaxSpindleRPM: rpm."""
        return Call("RMAC_Config.SetMechanismSpindleMaxRPM", {"MaxSpindleRPM": MaxSpindleRPM})

    @staticmethod
    def SetMechanismSpindleControlMethod(DMACServoControlMethod: enums.ServoControlMethod | int | str) -> Call[None]:
        """What the servo loop of every spindle controls: its speed, or its angle where its drive takes a torque."""
        return Call("RMAC_Config.SetMechanismSpindleControlMethod", {"DMACServoControlMethod": DMACServoControlMethod})

    @staticmethod
    def SetMechanismSpindleServoControlLaw(ControlLaw: str, Parameters: Mapping[str, Any] | None = None) -> Call[None]:
        """Servo law of every spindle, whose drives must take a torque; none where they follow speeds themselves. ControlLaw: DMAC_PID_CONTROL or another constant of Appendix IV, the name of a module, or empty for none. Parameters: its parameters, as in device.json; left out, a module that was chosen already keeps those it has, and another has none."""
        return Call("RMAC_Config.SetMechanismSpindleServoControlLaw", {"ControlLaw": ControlLaw, "Parameters": Parameters})

    @staticmethod
    def SetMechanismSpindleServoControlGains(ServoControlGains: types.Numbers) -> Call[None]:
        """Gains of the servo law of every spindle, in the law's own order. ServoControlGains: as the law declares."""
        return Call("RMAC_Config.SetMechanismSpindleServoControlGains", {"ServoControlGains": ServoControlGains})

    @staticmethod
    def SetMechanismDigitalControlInterface(DigitalControlInterface: str, Parameters: Mapping[str, Any] | None = None) -> Call[None]:
        """Interface to the drives. Apply brings them down and up again, because two cannot run one bus. DigitalControlInterface: name of a module. Parameters: its parameters, as in device.json; left out, a module that was chosen already keeps those it has, and another has none."""
        return Call("RMAC_Config.SetMechanismDigitalControlInterface", {"DigitalControlInterface": DigitalControlInterface, "Parameters": Parameters})

    @staticmethod
    def InitializeMechanismDigitalControlInterface() -> Call[bool]:
        """Checks that the interface to the drives can be made with its parameters; Apply brings it up."""
        return Call("RMAC_Config.InitializeMechanismDigitalControlInterface", {})

    @staticmethod
    def SetMechanismDigitalIOInterface(DigitalIOInterface: str, Parameters: Mapping[str, Any] | None = None) -> Call[None]:
        """Interface to inputs and outputs. DigitalIOInterface: name of a module. Parameters: its parameters, as in device.json; left out, a module that was chosen already keeps those it has, and another has none."""
        return Call("RMAC_Config.SetMechanismDigitalIOInterface", {"DigitalIOInterface": DigitalIOInterface, "Parameters": Parameters})

    @staticmethod
    def InitializeMechanismDigitalIOInterface() -> Call[bool]:
        """Checks that the interface to inputs and outputs can be made with its parameters; Apply brings it up."""
        return Call("RMAC_Config.InitializeMechanismDigitalIOInterface", {})

    @staticmethod
    def Apply() -> Call[bool]:
        """Checks the draft as a whole and puts it in at standstill, or in motion too where servo laws of joints, their parameters and gains, and position or velocity as what is controlled, are all that changed; or changes nothing and says why."""
        return Call("RMAC_Config.Apply", {})


class RMAC_CAM:
    @staticmethod
    def CycleStart(Mode: enums.CycleMode | int | str) -> Call[bool]:
        """Starts the cycle: AUTOMATIC runs the queue and what comes after it, MANUAL runs one move."""
        return Call("RMAC_CAM.CycleStart", {"Mode": Mode})

    @staticmethod
    def SetCycleStartStatus(status: bool) -> Call[None]:
        """The start button as an HMI sees it: true does what CycleStart(AUTOMATIC) does; false, its release, moves and stops nothing."""
        return Call("RMAC_CAM.SetCycleStartStatus", {"status": status})

    @staticmethod
    def GetCycleStartStatus() -> Call[bool]:
        """Whether the cycle is started."""
        return Call("RMAC_CAM.GetCycleStartStatus", {})

    @staticmethod
    def CycleStop(Mode: enums.CycleMode | int | str) -> Call[bool]:
        """Stops, whatever the mode, and keeps the rest of the queue; a new CycleStart goes on. On the path, as FeedHold."""
        return Call("RMAC_CAM.CycleStop", {"Mode": Mode})

    @staticmethod
    def SetCycleStopStatus(status: bool) -> Call[None]:
        """The stop button as an HMI sees it: true does what CycleStop does; false, its release, does not start anything."""
        return Call("RMAC_CAM.SetCycleStopStatus", {"status": status})

    @staticmethod
    def GetCycleStopStatus() -> Call[bool]:
        """Whether the cycle is stopped."""
        return Call("RMAC_CAM.GetCycleStopStatus", {})

    @staticmethod
    def StopNow() -> Call[bool]:
        """Stops as fast as the limits allow and empties the queue."""
        return Call("RMAC_CAM.StopNow", {})

    @staticmethod
    def FeedHold() -> Call[bool]:
        """Comes to rest on the path, or, where no plan for that is there within two cycles, joint by joint beside it (docs/safety.md); FeedResume goes on from there. The operator's also keeps everything from starting, at rest too, until an operator resumes."""
        return Call("RMAC_CAM.FeedHold", {})

    @staticmethod
    def FeedResume() -> Call[bool]:
        """Goes on after a FeedHold; from beside the path by way of where it was left, at 10 % of the joints' speeds. What the operator held only an operator resumes."""
        return Call("RMAC_CAM.FeedResume", {})

    @staticmethod
    def FeedRetrace(Distance: float) -> Call[float]:
        """Runs back along the path of what is held, then holds again; FeedResume runs forward from there. Distance: mm. Gives mm."""
        return Call("RMAC_CAM.FeedRetrace", {"Distance": Distance})

    @staticmethod
    def ParkProgram() -> Call[bool]:
        """Sets the program that is held aside, from its place on. The queue is empty then, spindle and coolant go off, and the machine may be jogged, measured with, and loaded in another role."""
        return Call("RMAC_CAM.ParkProgram", {})

    @staticmethod
    def TakeUpProgram() -> Call[bool]:
        """Queues the parked program again, in the part frame and with the tool in force now, and holds it; nothing moves before FeedResume, which switches spindle and coolant on again. The tool must stand within 1 mm of the place. When refused, the program stays parked."""
        return Call("RMAC_CAM.TakeUpProgram", {})

    @staticmethod
    def DropParkedProgram() -> Call[bool]:
        """Forgets the parked program."""
        return Call("RMAC_CAM.DropParkedProgram", {})

    @staticmethod
    def GetParkedProgram() -> Call[dict[str, Any]]:
        """The parked program: `mechanism`, `moves` to do, `move_id` and `s_mm` of the one that was begun, the `pose` in the part frame where it goes on, and how far the tool is `off_mm` it. Empty when none is parked."""
        return Call("RMAC_CAM.GetParkedProgram", {})

    @staticmethod
    def Reset() -> Call[bool]:
        """Leaves a fault or emergency stop whose cause is gone, takes over what an operator who has left holds, and clears the status codes; nothing moves by it."""
        return Call("RMAC_CAM.Reset", {})

    @staticmethod
    def SetFeedOverride(Percent: float) -> Call[None]:
        """Percentage of the programmed feed at which moves run, at once; 0 waits, and the 0 that an operator set only an operator raises. Percent: %."""
        return Call("RMAC_CAM.SetFeedOverride", {"Percent": Percent})

    @staticmethod
    def GetState() -> Call[dict[str, Any]]:
        """The machine's state now: what the topic `state` pushes."""
        return Call("RMAC_CAM.GetState", {})

    @staticmethod
    def GetCycleTimes() -> Call[dict[str, Any]]:
        """Where the servo thread's time goes, since the mechanism was put in: `deadline_misses`, and of `wake_up` (from when a cycle was due), `compute` (without the bus) and `bus` each `count`, `median_us`, `p99_us`, `p999_us`, `largest_us`, and `bins`, pairs of a bin's largest time in µs and how often it occurred."""
        return Call("RMAC_CAM.GetCycleTimes", {})

    @staticmethod
    def SetFeedrate(Feedrate: float) -> Call[None]:
        """Feed of the moves queued from now on; refused above the maximum. Feedrate: mm/min."""
        return Call("RMAC_CAM.SetFeedrate", {"Feedrate": Feedrate})

    @staticmethod
    def GetFeedrate() -> Call[float]:
        """Actual speed of the tool tip, from measured joints. Gives mm/min."""
        return Call("RMAC_CAM.GetFeedrate", {})

    @staticmethod
    def SetMaxFeedrate(MaxFeedrate: float) -> Call[None]:
        """Largest feed that SetFeedrate takes, at most the mechanism's own. MaxFeedrate: mm/min."""
        return Call("RMAC_CAM.SetMaxFeedrate", {"MaxFeedrate": MaxFeedrate})

    @staticmethod
    def GetMaxFeedrate() -> Call[float]:
        """Largest feed that SetFeedrate takes. Gives mm/min."""
        return Call("RMAC_CAM.GetMaxFeedrate", {})

    @staticmethod
    def SetPathAccelRise(newVal: float) -> Call[None]:
        """Acceleration along the path while the feed rises, for moves queued from now on. newVal: mm/s²."""
        return Call("RMAC_CAM.SetPathAccelRise", {"newVal": newVal})

    @staticmethod
    def GetPathAccelRise() -> Call[float]:
        """What SetPathAccelRise set; 0 while the joints alone bound it. Gives mm/s²."""
        return Call("RMAC_CAM.GetPathAccelRise", {})

    @staticmethod
    def SetPathAccelFall(newVal: float) -> Call[None]:
        """Deceleration along the path while the feed falls, for moves queued from now on. newVal: mm/s²."""
        return Call("RMAC_CAM.SetPathAccelFall", {"newVal": newVal})

    @staticmethod
    def GetPathAccelFall() -> Call[float]:
        """What SetPathAccelFall set; 0 while the joints alone bound it. Gives mm/s²."""
        return Call("RMAC_CAM.GetPathAccelFall", {})

    @staticmethod
    def SetJointInterpSpeed(newVal: float) -> Call[None]:
        """Speed of joint moves and jogs, of each joint's speed limit. newVal: %."""
        return Call("RMAC_CAM.SetJointInterpSpeed", {"newVal": newVal})

    @staticmethod
    def GetJointInterpSpeed() -> Call[float]:
        """What SetJointInterpSpeed set. Gives %."""
        return Call("RMAC_CAM.GetJointInterpSpeed", {})

    @staticmethod
    def SetJointAccelRise(JointNum: int, newVal: float) -> Call[None]:
        """Acceleration of one joint in joint moves while its speed rises. newVal: mm/s² or deg/s²."""
        return Call("RMAC_CAM.SetJointAccelRise", {"JointNum": JointNum, "newVal": newVal})

    @staticmethod
    def GetJointAccelRise(JointNum: int) -> Call[float]:
        """What SetJointAccelRise set. Gives mm/s² or deg/s²."""
        return Call("RMAC_CAM.GetJointAccelRise", {"JointNum": JointNum})

    @staticmethod
    def SetJointAccelFall(JointNum: int, newVal: float) -> Call[None]:
        """Deceleration of one joint in joint moves while its speed falls. newVal: mm/s² or deg/s²."""
        return Call("RMAC_CAM.SetJointAccelFall", {"JointNum": JointNum, "newVal": newVal})

    @staticmethod
    def GetJointAccelFall(JointNum: int) -> Call[float]:
        """What SetJointAccelFall set. Gives mm/s² or deg/s²."""
        return Call("RMAC_CAM.GetJointAccelFall", {"JointNum": JointNum})

    @staticmethod
    def SetPathTolerance(Tolerance: float) -> Call[None]:
        """How far the path of moves queued from now on may be from what was programmed, so that corners, jumps of curvature and short lines are passed at speed. 0: an exact stop wherever the path is not smooth. Tolerance: mm."""
        return Call("RMAC_CAM.SetPathTolerance", {"Tolerance": Tolerance})

    @staticmethod
    def GetPathTolerance() -> Call[float]:
        """What SetPathTolerance set. Gives mm."""
        return Call("RMAC_CAM.GetPathTolerance", {})

    @staticmethod
    def SetOrientationTolerance(Tolerance: float) -> Call[None]:
        """How far the tool axis of moves queued from now on may be from what was programmed, beside SetPathTolerance of the tip; 0.1 unless set. 0: the axis is met exactly, so that the path stops wherever it does not turn smoothly. Tolerance: degrees."""
        return Call("RMAC_CAM.SetOrientationTolerance", {"Tolerance": Tolerance})

    @staticmethod
    def GetOrientationTolerance() -> Call[float]:
        """What SetOrientationTolerance set. Gives degrees."""
        return Call("RMAC_CAM.GetOrientationTolerance", {})

    @staticmethod
    def SetPartFrame(PartFrame: types.FrameLike) -> Call[None]:
        """Pose of the part frame in the machine frame, for the moves that follow. At rest. PartFrame: mm."""
        return Call("RMAC_CAM.SetPartFrame", {"PartFrame": PartFrame})

    @staticmethod
    def GetPartFrame() -> Call[types.WireFrame]:
        """What SetPartFrame set. Gives mm."""
        return Call("RMAC_CAM.GetPartFrame", {})

    @staticmethod
    def SetToolInterfaceFrame(ToolInterfaceFrame: types.FrameLike) -> Call[None]:
        """Pose of the tool tip on the tool interface. At rest. ToolInterfaceFrame: mm."""
        return Call("RMAC_CAM.SetToolInterfaceFrame", {"ToolInterfaceFrame": ToolInterfaceFrame})

    @staticmethod
    def GetToolInterfaceFrame() -> Call[types.WireFrame]:
        """What SetToolInterfaceFrame set. Gives mm."""
        return Call("RMAC_CAM.GetToolInterfaceFrame", {})

    @staticmethod
    def SetSpindleRPM(SpindleNumber: int, RPM: float) -> Call[None]:
        """Speed of a spindle; feed waits until it is reached. 0 stops it. RPM: rpm."""
        return Call("RMAC_CAM.SetSpindleRPM", {"SpindleNumber": SpindleNumber, "RPM": RPM})

    @staticmethod
    def GetSpindleRPM(SpindleNumber: int) -> Call[float]:
        """Measured speed of a spindle. Gives rpm."""
        return Call("RMAC_CAM.GetSpindleRPM", {"SpindleNumber": SpindleNumber})

    @staticmethod
    def SetSpindleMaxRPM(SpindleNumber: int, MaxRPM: float) -> Call[None]:
        """Largest speed that SetSpindleRPM takes, at most the mechanism's own. MaxRPM: rpm."""
        return Call("RMAC_CAM.SetSpindleMaxRPM", {"SpindleNumber": SpindleNumber, "MaxRPM": MaxRPM})

    @staticmethod
    def GetSpindleMaxRPM(SpindleNumber: int) -> Call[float]:
        """Largest speed that SetSpindleRPM takes. Gives rpm."""
        return Call("RMAC_CAM.GetSpindleMaxRPM", {"SpindleNumber": SpindleNumber})

    @staticmethod
    def TurnCoolantOn() -> Call[bool]:
        """Switches the output Coolant on."""
        return Call("RMAC_CAM.TurnCoolantOn", {})

    @staticmethod
    def TurnCoolantOff() -> Call[bool]:
        """Switches the output Coolant off."""
        return Call("RMAC_CAM.TurnCoolantOff", {})

    @staticmethod
    def SetOutput(Name: str, On: bool) -> Call[bool]:
        """Switches an output of the machine by its name, at once; within a program InTurn does it in its turn. Name: of DigitalIOInterface/Outputs in device.json."""
        return Call("RMAC_CAM.SetOutput", {"Name": Name, "On": On})

    @staticmethod
    def SetAnimation(mode: bool) -> Call[None]:
        """True streams to this connection, for an animation, where each link of the machine stands (topic animation, 60 Hz; what there is to draw gives GetGeometry) and the joint values (topic joints, 50 Hz), or faster where it is subscribed to so; false ends it."""
        return Call("RMAC_CAM.SetAnimation", {"mode": mode})

    @staticmethod
    def DoToolChange(ToolNumber: int) -> Call[bool]:
        """Changes the tool when the moves queued before it are done; moves queued after it are with the new tool. Without a changer the machine stops, spindle and coolant too, and waits for a person. ToolNumber: 0: an empty spindle."""
        return Call("RMAC_CAM.DoToolChange", {"ToolNumber": ToolNumber})

    @staticmethod
    def ConfirmToolChange(ToolNumber: int) -> Call[bool]:
        """A person at the machine says that this tool is in the spindle: the one that was asked for, and the moves behind the change go on; or, when that is not known because a change was not completed, the one that is there. Whoever is connected may say it: it starts nothing that the holder of authority did not queue. ToolNumber: 0: an empty spindle."""
        return Call("RMAC_CAM.ConfirmToolChange", {"ToolNumber": ToolNumber})

    @staticmethod
    def GetTools() -> Call[dict[str, Any]]:
        """The mechanism's tool table; the number of the tool in the spindle (0: none, null: not known) and of the one that the next queued change wants (null: none); and what a person was asked to do."""
        return Call("RMAC_CAM.GetTools", {})

    @staticmethod
    def SetTool(ToolNumber: int, Length: float, Radius: float | None = None, Name: str | None = None, Frame: types.FrameLike | None = None, MaxRPM: float | None = None, MaxTorque: float | None = None, NeedsSpindle: bool | None = None) -> Call[None]:
        """Adds a tool to the mechanism's table, or replaces the one of its number; of the tool in the spindle at rest, and in force at once. Length: mm. Radius: mm. Frame: mm; where it sits on the tool interface before its length: an angle head's turn; unturned unless given. MaxRPM: rpm; 0: as fast as the spindle can. MaxTorque: N·m; 0: not given; nobody watches it. NeedsSpindle: feed moves are refused while the spindle stands; true unless given."""
        return Call("RMAC_CAM.SetTool", {"ToolNumber": ToolNumber, "Length": Length, "Radius": Radius, "Name": Name, "Frame": Frame, "MaxRPM": MaxRPM, "MaxTorque": MaxTorque, "NeedsSpindle": NeedsSpindle})

    @staticmethod
    def RemoveTool(ToolNumber: int) -> Call[None]:
        """Takes a tool out of the mechanism's table; not the one in the spindle."""
        return Call("RMAC_CAM.RemoveTool", {"ToolNumber": ToolNumber})

    @staticmethod
    def SetSetup(Setup: Mapping[str, Any] | None = None) -> Call[None]:
        """Says what stands on the table: stock, part and fixtures, for SetCollisionCheck. All of it is in force, or nothing of it. Needs rest and an empty queue; loading or unloading a machine drops it. Setup: as setup.json, but for meshes, which have Points and Triangles instead of a File; null, or left out: nothing stands there, and the check is switched off."""
        return Call("RMAC_CAM.SetSetup", {"Setup": Setup})

    @staticmethod
    def GetSetup() -> Call[dict[str, Any]]:
        """What SetSetup set, as it was sent; empty: nothing is known of the table."""
        return Call("RMAC_CAM.GetSetup", {})

    @staticmethod
    def SetCollisionCheck(On: bool) -> Call[None]:
        """Switches the check of the path against the machine's bodies and the set-up on or off; off at first. While it is on nothing is planned that was not checked: the machine comes to rest before bodies come nearer to each other than the set-up's Clearance, and the event CollisionAhead says which. Needs rest and an empty queue."""
        return Call("RMAC_CAM.SetCollisionCheck", {"On": On})

    @staticmethod
    def GetCollisionCheck() -> Call[bool]:
        """Whether what moves is checked before it does."""
        return Call("RMAC_CAM.GetCollisionCheck", {})

    @staticmethod
    def SetLearnedOffsets(Learned: Mapping[str, Any] | None = None) -> Call[None]:
        """Has joints' servo laws make good what was learned of a program that is repeated, place by place on its path (docs/servo.md). Setpoints as they are told, watched and recorded stay the program's. Needs rest and an empty queue. Ends with motion authority, and when a machine is loaded, unloaded or configured. Learned: as rmac run --learn writes it; null, or left out: nothing is made good any more."""
        return Call("RMAC_CAM.SetLearnedOffsets", {"Learned": Learned})

    @staticmethod
    def GetLearnedOffsets() -> Call[dict[str, Any]]:
        """What there is to know for who learns a program: Machine, Configuration (changes with gains, filters, limits, …), Virtual, Period (s), of each of the Joints its Name, LargestOffset (mm or deg; 0: its drive closes its loop itself) and AnswerDelay (cycles); and how many Moves and Knots are in force."""
        return Call("RMAC_CAM.GetLearnedOffsets", {})

    @staticmethod
    def GetGeometry() -> Call[dict[str, Any]]:
        """What there is to draw of the loaded machine: the solids of its links, each with its pose while all joints stand at 0, names of links and joints, and where the tool interface is; `missing` says what is not known. Asked for once, and again when `geometry` in the topic animation is another number."""
        return Call("RMAC_CAM.GetGeometry", {})

    @staticmethod
    def GetMesh(Body: str) -> Call[dict[str, Any]]:
        """The surface of a body of GetGeometry that is a mesh, in mm: `Points` and `Triangles`. At most 50000 triangles, from a file of at most 16 MiB. Body: its Name."""
        return Call("RMAC_CAM.GetMesh", {"Body": Body})

    @staticmethod
    def MoveAlongNurbsND(MoveID: int, NurbsND: types.NurbsLike) -> Call[bool]:
        """Queues a NURBS in joint space or with a tool axis; evaluated exactly, never cut into lines. MoveID: the client's number; comes back in events and records. NurbsND: mm or deg."""
        return Call("RMAC_CAM.MoveAlongNurbsND", {"MoveID": MoveID, "NurbsND": NurbsND})

    @staticmethod
    def MoveAlongNurbs(MoveID: int, Nurbs: types.NurbsLike) -> Call[bool]:
        """Queues a NURBS of the tool tip; the axis stays as it is when it begins. MoveID: the client's number; comes back in events and records. Nurbs: mm."""
        return Call("RMAC_CAM.MoveAlongNurbs", {"MoveID": MoveID, "Nurbs": Nurbs})

    @staticmethod
    def MoveAlongArc3(MoveID: int, ViaPoint: types.Vector, StartPoint: types.FrameLike, EndPoint: types.FrameLike) -> Call[bool]:
        """Queues a circular arc through a point. MoveID: the client's number; comes back in events and records. ViaPoint: mm. StartPoint: mm. EndPoint: mm."""
        return Call("RMAC_CAM.MoveAlongArc3", {"MoveID": MoveID, "ViaPoint": ViaPoint, "StartPoint": StartPoint, "EndPoint": EndPoint})

    @staticmethod
    def MoveAlongArc(MoveID: int, RotSign: enums.RotSign | int | str, Closed: bool, CenterPoint: types.FrameLike, StartPoint: types.FrameLike, EndPoint: types.FrameLike, Turns: int | None = None) -> Call[bool]:
        """Queues a circular arc about the axis of CenterPoint; Closed makes it a full circle. Where EndPoint lies off its plane, along the axis, it is a helix of even pitch. MoveID: the client's number; comes back in events and records. CenterPoint: mm. StartPoint: mm. EndPoint: mm. Turns: whole turns more."""
        return Call("RMAC_CAM.MoveAlongArc", {"MoveID": MoveID, "RotSign": RotSign, "Closed": Closed, "CenterPoint": CenterPoint, "StartPoint": StartPoint, "EndPoint": EndPoint, "Turns": Turns})

    @staticmethod
    def MoveAlongLine(MoveID: int, StartPoint: types.FrameLike, EndPoint: types.FrameLike) -> Call[bool]:
        """Queues a straight line; the tool axis turns evenly along it. MoveID: the client's number; comes back in events and records. StartPoint: mm. EndPoint: mm."""
        return Call("RMAC_CAM.MoveAlongLine", {"MoveID": MoveID, "StartPoint": StartPoint, "EndPoint": EndPoint})

    @staticmethod
    def MoveToPathTarget(MoveID: int, TargetFrame: types.FrameLike) -> Call[bool]:
        """Queues a positioning move: the tool tip on a line from where the queue ends, from rest to rest. MoveID: the client's number; comes back in events and records. TargetFrame: mm."""
        return Call("RMAC_CAM.MoveToPathTarget", {"MoveID": MoveID, "TargetFrame": TargetFrame})

    @staticmethod
    def MoveToJointTarget(MoveID: int, JointTargetFrame: types.FrameLike | types.Joints) -> Call[bool]:
        """Queues a positioning move: all joints together, from rest to rest. MoveID: the client's number; comes back in events and records. JointTargetFrame: mm or deg; a frame, or {"joints": [...]}."""
        return Call("RMAC_CAM.MoveToJointTarget", {"MoveID": MoveID, "JointTargetFrame": JointTargetFrame})

    @staticmethod
    def Dwell(MoveID: int, Time: float) -> Call[bool]:
        """Queues a rest of so long (G4). Time that the program is held does not count. MoveID: the client's number; comes back in events and records. Time: s."""
        return Call("RMAC_CAM.Dwell", {"MoveID": MoveID, "Time": Time})

    @staticmethod
    def ProgramStop(MoveID: int, Optional: bool | None = None, Message: str | None = None) -> Call[bool]:
        """Queues a stop (M0; optional: M1): the program is held at rest there, the event ProgramStopped tells why, and FeedResume goes on. Spindle and outputs stay as they are. MoveID: the client's number; comes back in events and records. Optional: true: passed over unless SetOptionalStop switched optional stops on before its turn comes. Message: for the person at the machine, at most 200 bytes."""
        return Call("RMAC_CAM.ProgramStop", {"MoveID": MoveID, "Optional": Optional, "Message": Message})

    @staticmethod
    def AwaitInput(MoveID: int, Name: str, On: bool, TimeOut: float) -> Call[bool]:
        """Queues a rest until a named input of the machine is on, or off. When it is not within the time-out, the program is held, and ProgramStopped tells what it waited for; FeedResume waits once more. In virtual mode every input is as it is waited for. MoveID: the client's number; comes back in events and records. Name: of DigitalIOInterface/Inputs in device.json. TimeOut: s."""
        return Call("RMAC_CAM.AwaitInput", {"MoveID": MoveID, "Name": Name, "On": On, "TimeOut": TimeOut})

    @staticmethod
    def InTurn(MoveID: int, Calls: Sequence[Mapping[str, Any]]) -> Call[bool]:
        """Queues calls between moves: `SetSpindleRPM`, `TurnCoolantOn`, `TurnCoolantOff`, `SetOutput`, made in their order when the moves before them are done. What follows waits for the spindles' speeds. MoveID: the client's number; comes back in events and records. Calls: each `{"method", "params"}`, as it would be sent."""
        return Call("RMAC_CAM.InTurn", {"MoveID": MoveID, "Calls": Calls})

    @staticmethod
    def SetOptionalStop(On: bool) -> Call[None]:
        """Switches optional stops on or off, as the switch on a panel does; off at first. A stop whose turn comes afterwards goes by it."""
        return Call("RMAC_CAM.SetOptionalStop", {"On": On})

    @staticmethod
    def GetOptionalStop() -> Call[bool]:
        """What SetOptionalStop set."""
        return Call("RMAC_CAM.GetOptionalStop", {})

    @staticmethod
    def CurrentPosition() -> Call[list[float]]:
        """Measured joint positions, joint 0 first. Gives mm or deg."""
        return Call("RMAC_CAM.CurrentPosition", {})

    @staticmethod
    def NumMovesInBuffer() -> Call[int]:
        """Moves queued and not yet done."""
        return Call("RMAC_CAM.NumMovesInBuffer", {})

    @overload
    @staticmethod
    def StatusMajorCode() -> Call[enums.StatusMajorCode]: ...
    @overload
    @staticmethod
    def StatusMajorCode(newVal: enums.StatusMajorCode | int | str) -> Call[bool]: ...
    @staticmethod
    def StatusMajorCode(newVal: enums.StatusMajorCode | int | str | None = None) -> Any:
        """Whether the machine met an error since the code was cleared."""
        if newVal is not None:
            return Call("RMAC_CAM.StatusMajorCode", {"newVal": newVal})
        return Call("RMAC_CAM.StatusMajorCode", {}, enums.StatusMajorCode)

    @overload
    @staticmethod
    def StatusMinorCode() -> Call[enums.StatusMinorCode]: ...
    @overload
    @staticmethod
    def StatusMinorCode(newVal: enums.StatusMinorCode | int | str) -> Call[bool]: ...
    @staticmethod
    def StatusMinorCode(newVal: enums.StatusMinorCode | int | str | None = None) -> Any:
        """Which error the machine met last."""
        if newVal is not None:
            return Call("RMAC_CAM.StatusMinorCode", {"newVal": newVal})
        return Call("RMAC_CAM.StatusMinorCode", {}, enums.StatusMinorCode)

    @staticmethod
    def Ok() -> Call[bool]:
        """True when the machine met no error since the status codes were cleared."""
        return Call("RMAC_CAM.Ok", {})

    @staticmethod
    def LastHitPosition() -> Call[list[float]]:
        """Joint positions at the last hit of the probe. Gives mm or deg."""
        return Call("RMAC_CAM.LastHitPosition", {})

    @overload
    @staticmethod
    def ControlMode() -> Call[enums.ControlMode]: ...
    @overload
    @staticmethod
    def ControlMode(newVal: enums.ControlMode | int | str) -> Call[bool]: ...
    @staticmethod
    def ControlMode(newVal: enums.ControlMode | int | str | None = None) -> Any:
        """What the measuring machine is doing."""
        if newVal is not None:
            return Call("RMAC_CAM.ControlMode", {"newVal": newVal})
        return Call("RMAC_CAM.ControlMode", {}, enums.ControlMode)

    @overload
    @staticmethod
    def Parameter(ParamNumber: enums.ParamNumber | int | str) -> Call[float]: ...
    @overload
    @staticmethod
    def Parameter(ParamNumber: enums.ParamNumber | int | str, newVal: float) -> Call[bool]: ...
    @staticmethod
    def Parameter(ParamNumber: enums.ParamNumber | int | str, newVal: float | None = None) -> Any:
        """A distance or speed of probing. newVal: mm or mm/s. Gives mm or mm/s."""
        if newVal is not None:
            return Call("RMAC_CAM.Parameter", {"ParamNumber": ParamNumber, "newVal": newVal})
        return Call("RMAC_CAM.Parameter", {"ParamNumber": ParamNumber})

    @staticmethod
    def NewHit() -> Call[bool]:
        """Whether the probe was hit since the positions were read last."""
        return Call("RMAC_CAM.NewHit", {})

    @staticmethod
    def ProbeActive() -> Call[bool]:
        """Whether the probe has power and answers."""
        return Call("RMAC_CAM.ProbeActive", {})

    @staticmethod
    def Home() -> Call[bool]:
        """Has the drives look for home that device.json gives a HomingTurn; where there are none, moves all joints to their home position, zero. From rest."""
        return Call("RMAC_CAM.Home", {})

    @staticmethod
    def MoveToXYZ(MoveID: int, x: float, y: float, z: float, Speed: float) -> Call[bool]:
        """Moves the tip to a point at a speed. MoveID: the client's number; comes back in events and records. x: mm. y: mm. z: mm. Speed: mm/s."""
        return Call("RMAC_CAM.MoveToXYZ", {"MoveID": MoveID, "x": x, "y": y, "z": z, "Speed": Speed})

    @staticmethod
    def MoveRotaryAxis(MoveID: int, JointNum: int, JointPose: float, Direction: enums.Direction | int | str, Speed: float) -> Call[bool]:
        """Turns one rotary joint to a position. MoveID: the client's number; comes back in events and records. JointPose: deg. Speed: deg/s."""
        return Call("RMAC_CAM.MoveRotaryAxis", {"MoveID": MoveID, "JointNum": JointNum, "JointPose": JointPose, "Direction": Direction, "Speed": Speed})

    @staticmethod
    def AutoMeasure(MoveID: int, x: float, y: float, z: float, Speed: float) -> Call[bool]:
        """Moves towards a point until the probe is hit, then backs off. MoveID: the client's number; comes back in events and records. x: mm. y: mm. z: mm. Speed: mm/s."""
        return Call("RMAC_CAM.AutoMeasure", {"MoveID": MoveID, "x": x, "y": y, "z": z, "Speed": Speed})

    @staticmethod
    def MoveInArc(MoveID: int, x: float, y: float, z: float, CenterX: float, CenterY: float, CenterZ: float, i: float, j: float, k: float, Speed: float) -> Call[bool]:
        """Moves on an arc from the present position to a point. MoveID: the client's number; comes back in events and records. x: mm. y: mm. z: mm. CenterX: mm. CenterY: mm. CenterZ: mm. Speed: mm/s."""
        return Call("RMAC_CAM.MoveInArc", {"MoveID": MoveID, "x": x, "y": y, "z": z, "CenterX": CenterX, "CenterY": CenterY, "CenterZ": CenterZ, "i": i, "j": j, "k": k, "Speed": Speed})

    @staticmethod
    def MoveAllAxis(MoveID: int, Position: types.Numbers, LinearSpeed: float) -> Call[bool]:
        """Moves all joints to their positions at a speed. MoveID: the client's number; comes back in events and records. Position: mm or deg. LinearSpeed: mm/s."""
        return Call("RMAC_CAM.MoveAllAxis", {"MoveID": MoveID, "Position": Position, "LinearSpeed": LinearSpeed})

    @staticmethod
    def SendConditionChangedEvent(JointValues: types.Numbers, NumJoints: int, Mask: int | str, Condition: int | str) -> Call[bool]:
        """In virtual mode: the probe is deflected with the joints there, or lets go. JointValues: mm or deg. Mask: bit 0: the probe. Condition: bit 0: it touches."""
        return Call("RMAC_CAM.SendConditionChangedEvent", {"JointValues": JointValues, "NumJoints": NumJoints, "Mask": Mask, "Condition": Condition})

    @staticmethod
    def SetCalibratedPartFrame() -> Call[bool]:
        """Puts the part frame where the tool tip is, its Z along the tool axis, at rest: the tip's pose reads zero there. CurrentPosition goes on to give the joints' own values (docs/decisions/0011)."""
        return Call("RMAC_CAM.SetCalibratedPartFrame", {})

    @staticmethod
    def ManualMeasure() -> Call[bool]:
        """Lets a person jog the probe and expects hits, which end the jog, or a move and what is queued behind it."""
        return Call("RMAC_CAM.ManualMeasure", {})

    @staticmethod
    def SpinProbe(RPM: float, Seconds: float) -> Call[bool]:
        """Spins the probe for a time. RPM: rpm. Seconds: s."""
        return Call("RMAC_CAM.SpinProbe", {"RPM": RPM, "Seconds": Seconds})

    @staticmethod
    def JogJoint(JntNum: int, Distance: float | None = None, Velocity: float | None = None) -> Call[bool]:
        """Moves one joint from rest: by a distance at the joint interpolation speed, or at a velocity for 200 ms, on and on while it is sent again. Distance: mm or deg. Velocity: mm/s or deg/s; 0 stops; instead of Distance."""
        return Call("RMAC_CAM.JogJoint", {"JntNum": JntNum, "Distance": Distance, "Velocity": Velocity})

    @staticmethod
    def JogPath(Direction: types.Vector, Distance: float | None = None, Velocity: float | None = None, InToolFrame: bool | None = None) -> Call[bool]:
        """Moves the tool tip straight from rest, the tool axis staying as it is: by a distance at the feed in force, or at a velocity for 200 ms, on and on while it is sent again. Direction: mm. Distance: mm. Velocity: mm/s; 0 stops; instead of Distance. InToolFrame: the direction is the tool's, Z along its axis; else the part's."""
        return Call("RMAC_CAM.JogPath", {"Direction": Direction, "Distance": Distance, "Velocity": Velocity, "InToolFrame": InToolFrame})

    @staticmethod
    def MoveToReferencePoint() -> Call[bool]:
        """Moves the tip straight to the zero of the part frame, from rest."""
        return Call("RMAC_CAM.MoveToReferencePoint", {})

    @staticmethod
    def SetJointForce(JntNum: int, Force: float) -> Call[bool]:
        """Contact force that a joint under force control keeps. Force: N or N·m; 0: hold the position; positive pushes towards larger positions."""
        return Call("RMAC_CAM.SetJointForce", {"JntNum": JntNum, "Force": Force})


class FlightRecorder:
    @staticmethod
    def Record() -> Call[str]:
        """Has the last seconds of every servo cycle written to a file, and gives its name. An event tells when it is there (FlightRecord), or why not (FlightRecordFailed)."""
        return Call("FlightRecorder.Record", {})

    @staticmethod
    def List() -> Call[dict[str, Any]]:
        """The flight records that there are, as `records`, oldest first; of each `name`, `cause` (fault, demand), `message`, `cycle`, `t_s`, `utc`, `mechanism`, `joints`, `first_cycle`, `last_cycle`, `bytes`."""
        return Call("FlightRecorder.List", {})

    @staticmethod
    def Read(Name: str, Offset: int | None = None) -> Call[dict[str, Any]]:
        """A part of a flight record's text: `text`, `next_offset` to go on with (null at the end), and `bytes`, the size of the whole. The first line is a JSON object, the rest CSV. Offset: bytes; 0 when left out."""
        return Call("FlightRecorder.Read", {"Name": Name, "Offset": Offset})


class Bus:
    @staticmethod
    def GetState() -> Call[dict[str, Any]]:
        """What the buses that run went through since they were started. `buses`: of each CANopen `interface`, its counts, whether it is `bus_off` or `link_down`, its `controller` with `state` and error counters (null: it has none, or does not tell), and its `nodes` with `state`, `problem` (null: none), how often they were `lost` and `recovered`, `missed_answers`, jitter, and the latest `emergencies` and `aborts`, newest first. `lines`: of each Modbus `endpoint`, its `units` with `state`, requests and what came of them, `exceptions` by code, and the `last_trouble` (null: none)."""
        return Call("Bus.GetState", {})


class Connection:
    @staticmethod
    def hello(client: str, version: str | None = None) -> Call[dict[str, Any]]:
        """Tells who calls, and asks who answers: name, version, units and limits. Optional, and good manners."""
        return Call("hello", {"client": client, "version": version})

    @staticmethod
    def subscribe(topics: Sequence[str], rate_hz: float | None = None) -> Call[bool]:
        """Pushes topics to this connection: state, joints, drives, animation, events. rate_hz: Hz; 100 when left out; more for one client at a time."""
        return Call("subscribe", {"topics": topics, "rate_hz": rate_hz})

    @staticmethod
    def unsubscribe(topics: Sequence[str] | None = None) -> Call[bool]:
        """Ends the pushing of topics; of all when none is named."""
        return Call("unsubscribe", {"topics": topics})

    @staticmethod
    def discover() -> Call[dict[str, Any]]:
        """This API as an OpenRPC document."""
        return Call("rpc.discover", {})


class Lease:
    @staticmethod
    def acquire() -> Call[dict[str, Any]]:
        """Takes motion authority, the lease that moving needs; one client at a time holds it. Gives `timeout_s`, the silence after which the lease ends (0: never), and `dropped_moves`, how many moves were dropped from the queue when the lease before it ended."""
        return Call("authority.acquire", {})

    @staticmethod
    def renew() -> Call[bool]:
        """Confirms that this connection still holds motion authority; like any request, it keeps the lease from ending."""
        return Call("authority.renew", {})

    @staticmethod
    def release() -> Call[bool]:
        """Gives motion authority back. As when a lease is lost, a machine that moves is stopped, and what is queued is dropped."""
        return Call("authority.release", {})


class Post:
    @staticmethod
    def acquire() -> Call[dict[str, Any]]:
        """Takes the operator's place beside the holder of authority, or together with authority; one client at a time has it. Its holder may set the feed override, resume and retrace, and what it holds by FeedHold, or by an override of 0, only an operator resumes. Gives `name`, and `held_by`, who holds the machine as operator already, or empty."""
        return Call("operator.acquire", {})

    @staticmethod
    def release() -> Call[bool]:
        """Gives the operator's place up, as the end of its connection does. Nothing moves or stops by it; what is held stays held until the next operator resumes it, or the holder of authority after a Reset."""
        return Call("operator.release", {})
