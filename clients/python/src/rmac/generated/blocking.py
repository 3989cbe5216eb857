"""Written by clients/python/generate.py from rpc.discover; do not edit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, overload

from rmac.generated import calls, enums, types
from rmac.generated.types import BlockingCaller


class DeviceDriverManager:
    def __init__(self, call: BlockingCaller) -> None:
        self._call = call

    def OpenDeviceDriverDatabase(self) -> bool:
        """Opens this connection's record set with every mechanism in it, the first one current."""
        return self._call(calls.DeviceDriverManager.OpenDeviceDriverDatabase())

    def CloseDeviceDriverDatabase(self) -> bool:
        """Closes this connection's record set."""
        return self._call(calls.DeviceDriverManager.CloseDeviceDriverDatabase())

    def GetTotalNumberOfRecords(self) -> int:
        """Number of mechanisms in the device driver database."""
        return self._call(calls.DeviceDriverManager.GetTotalNumberOfRecords())

    def SearchDatabaseRecordSet(self, MachineSQLStatement: str) -> int:
        """Replaces the record set by the mechanisms that a SELECT on the table DeviceDrivers finds; gives their number. MachineSQLStatement: one read-only SELECT that yields MechanismID (or *), within 200 ms."""
        return self._call(calls.DeviceDriverManager.SearchDatabaseRecordSet(MachineSQLStatement))

    def GetDatabaseRecordSetColumns(self) -> bool:
        """Checks that the record set has a current row; the getters below read it."""
        return self._call(calls.DeviceDriverManager.GetDatabaseRecordSetColumns())

    def OnNextRecord(self) -> None:
        """Goes to the next row; on the last one an error."""
        return self._call(calls.DeviceDriverManager.OnNextRecord())

    def OnPreviousRecord(self) -> None:
        """Goes to the row before; on the first one an error."""
        return self._call(calls.DeviceDriverManager.OnPreviousRecord())

    def OnFirstRecord(self) -> None:
        """Goes to the first row."""
        return self._call(calls.DeviceDriverManager.OnFirstRecord())

    def OnLastRecord(self) -> None:
        """Goes to the last row."""
        return self._call(calls.DeviceDriverManager.OnLastRecord())

    def Machine_GetMechanismID(self) -> int:
        """Number of the mechanism in the database."""
        return self._call(calls.DeviceDriverManager.Machine_GetMechanismID())

    def Machine_GetMechanismName(self) -> str:
        """Name of the mechanism."""
        return self._call(calls.DeviceDriverManager.Machine_GetMechanismName())

    def Machine_GetMechanismDeviceDriver(self) -> str:
        """Name of its device driver."""
        return self._call(calls.DeviceDriverManager.Machine_GetMechanismDeviceDriver())

    def Machine_GetMechanismDeviceDriverVersion(self) -> int:
        """Version of its device driver, 1.2.3 as 10203."""
        return self._call(calls.DeviceDriverManager.Machine_GetMechanismDeviceDriverVersion())

    def Machine_GetMechanismType(self) -> str:
        """What kind of machine it is, e.g. Mill."""
        return self._call(calls.DeviceDriverManager.Machine_GetMechanismType())

    def Machine_GetMechanismConfigurationType(self) -> str:
        """Its arrangement, e.g. 3-axis."""
        return self._call(calls.DeviceDriverManager.Machine_GetMechanismConfigurationType())

    def Machine_GetMechanismNumberOfJoints(self) -> int:
        """Number of joints it moves."""
        return self._call(calls.DeviceDriverManager.Machine_GetMechanismNumberOfJoints())

    def Machine_GetMechanismWorkingVolume(self) -> str:
        """Length, width and depth of the working volume, as "100x100x100". Gives mm."""
        return self._call(calls.DeviceDriverManager.Machine_GetMechanismWorkingVolume())

    def Machine_GetMechanismSpindleHorsePower(self) -> float:
        """Power of its spindle. Gives hp."""
        return self._call(calls.DeviceDriverManager.Machine_GetMechanismSpindleHorsePower())

    def Machine_GetMechanismSpindleMaxSpeed(self) -> float:
        """Largest speed of its spindle. Gives rpm."""
        return self._call(calls.DeviceDriverManager.Machine_GetMechanismSpindleMaxSpeed())

    def Machine_GetMechanismSpindleMaxTorque(self) -> float:
        """Largest torque of its spindle. Gives N·m."""
        return self._call(calls.DeviceDriverManager.Machine_GetMechanismSpindleMaxTorque())

    def Machine_GetMechanismMaxFeedrate(self) -> float:
        """Largest feed. Gives mm/min."""
        return self._call(calls.DeviceDriverManager.Machine_GetMechanismMaxFeedrate())

    def Machine_GetMechanismMaxPalletLoad(self) -> float:
        """Largest load on its table. Gives kg."""
        return self._call(calls.DeviceDriverManager.Machine_GetMechanismMaxPalletLoad())

    def Machine_GetMechanismPositioningTolerance(self) -> float:
        """How exactly it reaches a position. Gives mm."""
        return self._call(calls.DeviceDriverManager.Machine_GetMechanismPositioningTolerance())

    def Machine_GetMechanismRepeatabilityTolerance(self) -> float:
        """How exactly it reaches it again. Gives mm."""
        return self._call(calls.DeviceDriverManager.Machine_GetMechanismRepeatabilityTolerance())

    def Rescan(self) -> dict[str, Any]:
        """Reads the device tree again. Gives `mechanisms`, how many are in the database after it, and `problems`, what was left out: `file` and `message` of each."""
        return self._call(calls.DeviceDriverManager.Rescan())


class Device:
    def __init__(self, call: BlockingCaller) -> None:
        self._call = call

    def Load(self, Name: str, Virtual: bool | None = None, Soften: float | None = None) -> bool:
        """Loads a mechanism's device driver and configures the controller by it, at standstill; on any failure the mechanism that was loaded stays. Modules that did not pass their verification before are verified first. Virtual: true: setpoints come back as joint values and no bus is touched; false when left out. Soften: for commissioning: Kp and Kd of its PIDs divided by this, Ki by its square, and a quarter of their accelerations; 1 when left out."""
        return self._call(calls.Device.Load(Name, Virtual, Soften))

    def Unload(self) -> bool:
        """Takes the mechanism out at standstill: drives off, no motion until another is loaded."""
        return self._call(calls.Device.Unload())

    def Verify(self, Name: str) -> dict[str, Any]:
        """Checks a mechanism's modules in a separate process. Gives the report: `ok`, and `modules`, of each the checks that it `passed`, what was `not_checked`, and the `counter_example` that refuses it."""
        return self._call(calls.Device.Verify(Name))

    def GetModules(self) -> dict[str, Any]:
        """The modules that are in force, its device driver first. Gives `modules`: `role`, `module` and `build_id` of each."""
        return self._call(calls.Device.GetModules())

    def OpenDeviceDatabase(self) -> bool:
        """Has this connection read the loaded mechanism's database, as it does at first; an error where none is loaded."""
        return self._call(calls.Device.OpenDeviceDatabase())

    def CloseDeviceDatabase(self) -> bool:
        """Ends this connection's reading: the getters below refuse until it is opened again."""
        return self._call(calls.Device.CloseDeviceDatabase())

    def GetDatabaseRecordSetMechanismColumns(self) -> bool:
        """Checks that the mechanism's values are there; the getters below read them."""
        return self._call(calls.Device.GetDatabaseRecordSetMechanismColumns())

    def GetDatabaseRecordSetJointColumns(self, JntNum: int) -> bool:
        """Checks that this joint's values are there."""
        return self._call(calls.Device.GetDatabaseRecordSetJointColumns(JntNum))

    def Machine_GetMechanismName(self) -> str:
        """Name of the loaded mechanism."""
        return self._call(calls.Device.Machine_GetMechanismName())

    def Machine_GetMechanismKinematics(self) -> str:
        """Module that computes its kinematics."""
        return self._call(calls.Device.Machine_GetMechanismKinematics())

    def Machine_GetMechanismActuatorMap(self) -> str:
        """Module that maps its joints to actuators."""
        return self._call(calls.Device.Machine_GetMechanismActuatorMap())

    def Machine_GetMechanismNumberOfJoints(self) -> int:
        """Number of joints it moves, without held ones."""
        return self._call(calls.Device.Machine_GetMechanismNumberOfJoints())

    def Machine_GetMechanismConfiguration(self) -> str:
        """Its arrangement, e.g. 3-axis."""
        return self._call(calls.Device.Machine_GetMechanismConfiguration())

    def Machine_GetMechanismWorkingVolume(self) -> str:
        """Length, width and depth of the working volume, as "100x100x100". Gives mm."""
        return self._call(calls.Device.Machine_GetMechanismWorkingVolume())

    def Machine_GetMechanismMaxFeedrate(self) -> float:
        """Largest feed. Gives mm/min."""
        return self._call(calls.Device.Machine_GetMechanismMaxFeedrate())

    def Machine_GetMechanismSpindleHorsePower(self) -> float:
        """Power of spindle 0; 0 without a spindle. Gives hp."""
        return self._call(calls.Device.Machine_GetMechanismSpindleHorsePower())

    def Machine_GetMechanismSpindleMaxSpeed(self) -> float:
        """Largest speed of spindle 0. Gives rpm."""
        return self._call(calls.Device.Machine_GetMechanismSpindleMaxSpeed())

    def Machine_GetMechanismSpindleMaxTorque(self) -> float:
        """Largest torque of spindle 0. Gives N·m."""
        return self._call(calls.Device.Machine_GetMechanismSpindleMaxTorque())

    def Machine_GetMechanismMaxPalletLoad(self) -> float:
        """Largest load on its table. Gives kg."""
        return self._call(calls.Device.Machine_GetMechanismMaxPalletLoad())

    def Machine_GetMechanismPositioningTolerance(self) -> float:
        """How exactly it reaches a position. Gives mm."""
        return self._call(calls.Device.Machine_GetMechanismPositioningTolerance())

    def Machine_GetMechanismRepeatabilityTolerance(self) -> float:
        """How exactly it reaches it again. Gives mm."""
        return self._call(calls.Device.Machine_GetMechanismRepeatabilityTolerance())

    def Machine_GetMechanismJntTypes(self, JntNum: int) -> enums.JointType:
        """Whether the joint turns or slides."""
        return self._call(calls.Device.Machine_GetMechanismJntTypes(JntNum))

    def Machine_GetMechanismJntMaxLimit(self, JntNum: int) -> float:
        """Upper end of the joint's travel. Gives mm or deg."""
        return self._call(calls.Device.Machine_GetMechanismJntMaxLimit(JntNum))

    def Machine_GetMechanismJntMinLimit(self, JntNum: int) -> float:
        """Lower end of the joint's travel. Gives mm or deg."""
        return self._call(calls.Device.Machine_GetMechanismJntMinLimit(JntNum))

    def Machine_GetMechanismJntMaxSpeed(self, JntNum: int) -> float:
        """Largest speed of the joint. Gives mm/s or deg/s."""
        return self._call(calls.Device.Machine_GetMechanismJntMaxSpeed(JntNum))

    def Machine_GetMechanismJntMaxAccel(self, JntNum: int) -> float:
        """Largest acceleration of the joint. Gives mm/s² or deg/s²."""
        return self._call(calls.Device.Machine_GetMechanismJntMaxAccel(JntNum))

    def Machine_GetMechanismJntMaxJerk(self, JntNum: int) -> float:
        """Largest jerk of the joint. Gives mm/s³ or deg/s³."""
        return self._call(calls.Device.Machine_GetMechanismJntMaxJerk(JntNum))

    def Machine_GetMechanismJntServoControlLaw(self, JntNum: int) -> str:
        """Module that holds the joint's servo law."""
        return self._call(calls.Device.Machine_GetMechanismJntServoControlLaw(JntNum))

    def Machine_SetMechanismNumberOfJoints(self, NumJnts: int) -> None:
        """Wanted number of joints. Acts with the next Machine_ConfigureMotionPlanner, which refuses what modules do not fit."""
        return self._call(calls.Device.Machine_SetMechanismNumberOfJoints(NumJnts))

    def Machine_SetMechanismMaxFeedrate(self, MaxFeedrate: float) -> None:
        """Wanted largest feed. Acts with the next Machine_ConfigureMotionPlanner. MaxFeedrate: mm/min."""
        return self._call(calls.Device.Machine_SetMechanismMaxFeedrate(MaxFeedrate))

    def Machine_SetMechanismSpindleMaxSpeed(self, MaxSpindleSpeed: float) -> None:
        """Wanted largest speed of spindle 0. Acts with the next Machine_ConfigureMotionPlanner. MaxSpindleSpeed: rpm."""
        return self._call(calls.Device.Machine_SetMechanismSpindleMaxSpeed(MaxSpindleSpeed))

    def Machine_SetMechanismSpindleMaxTorque(self, MaxSpindleTorque: float) -> None:
        """Wanted largest torque of spindle 0: its servo law gives no more, and measured it is an overload that stops the machine. Acts with the next Machine_ConfigureMotionPlanner. MaxSpindleTorque: N·m."""
        return self._call(calls.Device.Machine_SetMechanismSpindleMaxTorque(MaxSpindleTorque))

    def Machine_SetMechanismJntTypes(self, JntNum: int, JntType: enums.JointType | int | str) -> None:
        """Wanted type of a joint. Acts with the next Machine_ConfigureMotionPlanner."""
        return self._call(calls.Device.Machine_SetMechanismJntTypes(JntNum, JntType))

    def Machine_SetMechanismJntMaxLimit(self, JntNum: int, MaxJntLimit: float) -> None:
        """Wanted upper end of a joint's travel. Acts with the next Machine_ConfigureMotionPlanner. MaxJntLimit: mm or deg."""
        return self._call(calls.Device.Machine_SetMechanismJntMaxLimit(JntNum, MaxJntLimit))

    def Machine_SetMechanismJntMinLimit(self, JntNum: int, MinJntLimit: float) -> None:
        """Wanted lower end of a joint's travel. Acts with the next Machine_ConfigureMotionPlanner. MinJntLimit: mm or deg."""
        return self._call(calls.Device.Machine_SetMechanismJntMinLimit(JntNum, MinJntLimit))

    def Machine_SetMechanismJntMaxSpeed(self, JntNum: int, MaxJntSpeed: float) -> None:
        """Wanted largest speed of a joint. Acts with the next Machine_ConfigureMotionPlanner. MaxJntSpeed: mm/s or deg/s."""
        return self._call(calls.Device.Machine_SetMechanismJntMaxSpeed(JntNum, MaxJntSpeed))

    def Machine_SetMechanismJntMaxAccel(self, JntNum: int, MaxJntAccel: float) -> None:
        """Wanted largest acceleration of a joint. Acts with the next Machine_ConfigureMotionPlanner. MaxJntAccel: mm/s² or deg/s²."""
        return self._call(calls.Device.Machine_SetMechanismJntMaxAccel(JntNum, MaxJntAccel))

    def Machine_SetMechanismJntMaxJerk(self, JntNum: int, MaxJntJerk: float) -> None:
        """Wanted largest jerk of a joint. Acts with the next Machine_ConfigureMotionPlanner. MaxJntJerk: mm/s³ or deg/s³."""
        return self._call(calls.Device.Machine_SetMechanismJntMaxJerk(JntNum, MaxJntJerk))

    def Machine_ConfigureMotionPlanner(self) -> bool:
        """The driver configures the motion planner by the wanted values: joints, limits, largest feed and speeds, at standstill; or nothing changes."""
        return self._call(calls.Device.Machine_ConfigureMotionPlanner())

    def Machine_ConfigureServoController(self) -> bool:
        """The driver puts the database's control methods, servo laws, gains and bounds of the following error back in, at standstill, whatever RMAC_Config made of them; or nothing changes. What the setters ask for waits for Machine_ConfigureMotionPlanner."""
        return self._call(calls.Device.Machine_ConfigureServoController())

    def Machine_ConfigureDigitalControlInterface(self) -> bool:
        """The driver puts the database's interfaces to drives and I/O back in, at standstill, whatever RMAC_Config made of them; or nothing changes."""
        return self._call(calls.Device.Machine_ConfigureDigitalControlInterface())

    def Machine_MoveInNurbsND(self, MoveID: int, NurbsND: types.NurbsLike) -> bool:
        """Queues a NURBS in joint space or with a tool axis; evaluated exactly, never cut into lines. MoveID: the client's number; comes back in events and records. NurbsND: mm or deg."""
        return self._call(calls.Device.Machine_MoveInNurbsND(MoveID, NurbsND))

    def Machine_MoveInNurbs(self, MoveID: int, Nurbs: types.NurbsLike) -> bool:
        """Queues a NURBS of the tool tip; the axis stays as it is when it begins. MoveID: the client's number; comes back in events and records. Nurbs: mm."""
        return self._call(calls.Device.Machine_MoveInNurbs(MoveID, Nurbs))

    def Machine_MoveInArc3(self, MoveID: int, ViaPoint: types.Vector, StartPoint: types.FrameLike, EndPoint: types.FrameLike) -> bool:
        """Queues a circular arc through a point. MoveID: the client's number; comes back in events and records. ViaPoint: mm. StartPoint: mm. EndPoint: mm."""
        return self._call(calls.Device.Machine_MoveInArc3(MoveID, ViaPoint, StartPoint, EndPoint))

    def Machine_MoveInArc(self, MoveID: int, RotSign: enums.RotSign | int | str, Closed: bool, CenterPoint: types.FrameLike, StartPoint: types.FrameLike, EndPoint: types.FrameLike, Turns: int | None = None) -> bool:
        """Queues a circular arc about the axis of CenterPoint; Closed makes it a full circle. Where EndPoint lies off its plane, along the axis, it is a helix of even pitch. MoveID: the client's number; comes back in events and records. CenterPoint: mm. StartPoint: mm. EndPoint: mm. Turns: whole turns more."""
        return self._call(calls.Device.Machine_MoveInArc(MoveID, RotSign, Closed, CenterPoint, StartPoint, EndPoint, Turns))

    def Machine_MoveInLine(self, MoveID: int, StartPoint: types.FrameLike, EndPoint: types.FrameLike) -> bool:
        """Queues a straight line; the tool axis turns evenly along it. MoveID: the client's number; comes back in events and records. StartPoint: mm. EndPoint: mm."""
        return self._call(calls.Device.Machine_MoveInLine(MoveID, StartPoint, EndPoint))

    def Machine_SetFeedrate(self, Feedrate: float) -> None:
        """Feed of the moves queued from now on; refused above the maximum. Feedrate: mm/min."""
        return self._call(calls.Device.Machine_SetFeedrate(Feedrate))

    def Machine_GetFeedrate(self) -> float:
        """Actual speed of the tool tip, from measured joints. Gives mm/min."""
        return self._call(calls.Device.Machine_GetFeedrate())


class RMAC_Config:
    def __init__(self, call: BlockingCaller) -> None:
        self._call = call

    def SetMechanismKinematics(self, DMACKin: str, Parameters: Mapping[str, Any] | None = None) -> None:
        """Module that computes the kinematics. DMACKin: name of a module. Parameters: its parameters, as in device.json; left out, a module that was chosen already keeps those it has, and another has none."""
        return self._call(calls.RMAC_Config.SetMechanismKinematics(DMACKin, Parameters))

    def SetMechanismActuatorMap(self, DMACMachineActMap: str, Parameters: Mapping[str, Any] | None = None) -> None:
        """Module that maps joints to actuators. DMACMachineActMap: name of a module. Parameters: its parameters, as in device.json; left out, a module that was chosen already keeps those it has, and another has none."""
        return self._call(calls.RMAC_Config.SetMechanismActuatorMap(DMACMachineActMap, Parameters))

    def SetMechanismNumJnts(self, NumJnts: int) -> None:
        """Number of joints that the mechanism moves. One that comes is as device.json has it, or waits for its setters."""
        return self._call(calls.RMAC_Config.SetMechanismNumJnts(NumJnts))

    def SetMechanismNumSpindle(self, NumSpindle: int, Buses: Sequence[Mapping[str, Any]] | None = None) -> None:
        """Number of spindles. Buses: for each its `Bus`, `Axis` and what else Spindles of device.json have (but for `Inputs`); what is left out stays as it is."""
        return self._call(calls.RMAC_Config.SetMechanismNumSpindle(NumSpindle, Buses))

    def SetMechanismNumActuators(self, NumActuators: int, Buses: Sequence[Mapping[str, Any]] | None = None) -> None:
        """Number of actuators behind joints and held joints. Buses: for each its `Bus`, `Axis` and what else Actuators of device.json have (but for `Inputs`); what is left out stays as it is."""
        return self._call(calls.RMAC_Config.SetMechanismNumActuators(NumActuators, Buses))

    def SetMechanismMaxFeedrate(self, MaxFeedrate: float) -> None:
        """Largest feed of the mechanism. MaxFeedrate: mm/min."""
        return self._call(calls.RMAC_Config.SetMechanismMaxFeedrate(MaxFeedrate))

    def SetMechanismJointName(self, JntNum: int, Name: str) -> None:
        """Name of a joint; every joint has one of its own."""
        return self._call(calls.RMAC_Config.SetMechanismJointName(JntNum, Name))

    def SetMechanismJointType(self, JntNum: int, JointType: enums.JointType | int | str) -> None:
        """Whether a joint turns, slides or screws."""
        return self._call(calls.RMAC_Config.SetMechanismJointType(JntNum, JointType))

    def SetMechanismJointLimitType(self, JntNum: int, JointLimitType: enums.JointLimitType | int | str) -> None:
        """On which sides a joint's travel ends."""
        return self._call(calls.RMAC_Config.SetMechanismJointLimitType(JntNum, JointLimitType))

    def SetMechanismJointMaximumLimit(self, JntNum: int, MaxJntLimit: float) -> None:
        """Upper end of a joint's travel. MaxJntLimit: mm or deg."""
        return self._call(calls.RMAC_Config.SetMechanismJointMaximumLimit(JntNum, MaxJntLimit))

    def SetMechanismJointMinimumLimit(self, JntNum: int, MinJntLimit: float) -> None:
        """Lower end of a joint's travel. MinJntLimit: mm or deg."""
        return self._call(calls.RMAC_Config.SetMechanismJointMinimumLimit(JntNum, MinJntLimit))

    def SetMechanismJointMaximumSpeed(self, JntNum: int, MaxJntSpeed: float) -> None:
        """Largest speed of a joint. MaxJntSpeed: mm/s or deg/s."""
        return self._call(calls.RMAC_Config.SetMechanismJointMaximumSpeed(JntNum, MaxJntSpeed))

    def SetMechanismJointMaximumAcceleration(self, JntNum: int, MaxJntAccel: float) -> None:
        """Largest acceleration of a joint. MaxJntAccel: mm/s² or deg/s²."""
        return self._call(calls.RMAC_Config.SetMechanismJointMaximumAcceleration(JntNum, MaxJntAccel))

    def SetMechanismJointMaximumJerk(self, JntNum: int, MaxJntJerk: float) -> None:
        """Largest jerk of a joint. MaxJntJerk: mm/s³ or deg/s³."""
        return self._call(calls.RMAC_Config.SetMechanismJointMaximumJerk(JntNum, MaxJntJerk))

    def SetMechanismJointControlMethod(self, JntNum: int, DMACServoControlMethod: enums.ServoControlMethod | int | str) -> None:
        """What a joint's servo loop controls."""
        return self._call(calls.RMAC_Config.SetMechanismJointControlMethod(JntNum, DMACServoControlMethod))

    def SetMechanismJointServoControlGains(self, JntNum: int, ServoControlGains: types.Numbers) -> None:
        """Gains of a joint's servo law, in the law's own order. ServoControlGains: as the law declares."""
        return self._call(calls.RMAC_Config.SetMechanismJointServoControlGains(JntNum, ServoControlGains))

    def SetMechanismJointServoControlLaw(self, JntNum: int, ControlLaw: str, Parameters: Mapping[str, Any] | None = None) -> None:
        """Servo law of a joint. ControlLaw: DMAC_PID_CONTROL or another constant of Appendix IV, or the name of a module. Parameters: its parameters, as in device.json; left out, a module that was chosen already keeps those it has, and another has none."""
        return self._call(calls.RMAC_Config.SetMechanismJointServoControlLaw(JntNum, ControlLaw, Parameters))

    def SetMechanismJointWatch(self, JntNum: int, MaxFollowingError: float, MaxEffort: float) -> None:
        """How far a joint may fall behind, and how hard it may be driven, before the machine stops. MaxFollowingError: mm or deg. MaxEffort: N or N·m."""
        return self._call(calls.RMAC_Config.SetMechanismJointWatch(JntNum, MaxFollowingError, MaxEffort))

    def SetMechanismJointServoControlParameter(self, JntNum: int, Name: str, Value: float) -> None:
        """A parameter of a joint's servo law beside its gains: lead_s, rest_band, … Another law forgets it. Name: as docs/servo.md has it. Value: as the law declares."""
        return self._call(calls.RMAC_Config.SetMechanismJointServoControlParameter(JntNum, Name, Value))

    def SetMechanismJointFilters(self, JntNum: int, LowPass: float, Resonances: Sequence[Mapping[str, Any]]) -> None:
        """Filters of a joint's effort: a notch for each resonance, and a low-pass. They take the place of those that it has. LowPass: Hz; 0 for none. Resonances: as in device.json; [] for none."""
        return self._call(calls.RMAC_Config.SetMechanismJointFilters(JntNum, LowPass, Resonances))

    def SetMechanismSpindleMaxRPM(self, MaxSpindleRPM: float) -> None:
        """Largest speed of every spindle. MaxSpindleRPM: rpm."""
        return self._call(calls.RMAC_Config.SetMechanismSpindleMaxRPM(MaxSpindleRPM))

    def SetMechanismSpindleControlMethod(self, DMACServoControlMethod: enums.ServoControlMethod | int | str) -> None:
        """What the servo loop of every spindle controls: its speed, or its angle where its drive takes a torque."""
        return self._call(calls.RMAC_Config.SetMechanismSpindleControlMethod(DMACServoControlMethod))

    def SetMechanismSpindleServoControlLaw(self, ControlLaw: str, Parameters: Mapping[str, Any] | None = None) -> None:
        """Servo law of every spindle, whose drives must take a torque; none where they follow speeds themselves. ControlLaw: DMAC_PID_CONTROL or another constant of Appendix IV, the name of a module, or empty for none. Parameters: its parameters, as in device.json; left out, a module that was chosen already keeps those it has, and another has none."""
        return self._call(calls.RMAC_Config.SetMechanismSpindleServoControlLaw(ControlLaw, Parameters))

    def SetMechanismSpindleServoControlGains(self, ServoControlGains: types.Numbers) -> None:
        """Gains of the servo law of every spindle, in the law's own order. ServoControlGains: as the law declares."""
        return self._call(calls.RMAC_Config.SetMechanismSpindleServoControlGains(ServoControlGains))

    def SetMechanismDigitalControlInterface(self, DigitalControlInterface: str, Parameters: Mapping[str, Any] | None = None) -> None:
        """Interface to the drives. Apply brings them down and up again, because two cannot run one bus. DigitalControlInterface: name of a module. Parameters: its parameters, as in device.json; left out, a module that was chosen already keeps those it has, and another has none."""
        return self._call(calls.RMAC_Config.SetMechanismDigitalControlInterface(DigitalControlInterface, Parameters))

    def InitializeMechanismDigitalControlInterface(self) -> bool:
        """Checks that the interface to the drives can be made with its parameters; Apply brings it up."""
        return self._call(calls.RMAC_Config.InitializeMechanismDigitalControlInterface())

    def SetMechanismDigitalIOInterface(self, DigitalIOInterface: str, Parameters: Mapping[str, Any] | None = None) -> None:
        """Interface to inputs and outputs. DigitalIOInterface: name of a module. Parameters: its parameters, as in device.json; left out, a module that was chosen already keeps those it has, and another has none."""
        return self._call(calls.RMAC_Config.SetMechanismDigitalIOInterface(DigitalIOInterface, Parameters))

    def InitializeMechanismDigitalIOInterface(self) -> bool:
        """Checks that the interface to inputs and outputs can be made with its parameters; Apply brings it up."""
        return self._call(calls.RMAC_Config.InitializeMechanismDigitalIOInterface())

    def Apply(self) -> bool:
        """Checks the draft as a whole and puts it in at standstill, or in motion too where servo laws of joints, their parameters and gains, and position or velocity as what is controlled, are all that changed; or changes nothing and says why."""
        return self._call(calls.RMAC_Config.Apply())


class RMAC_CAM:
    def __init__(self, call: BlockingCaller) -> None:
        self._call = call

    def CycleStart(self, Mode: enums.CycleMode | int | str) -> bool:
        """Starts the cycle: AUTOMATIC runs the queue and what comes after it, MANUAL runs one move."""
        return self._call(calls.RMAC_CAM.CycleStart(Mode))

    def SetCycleStartStatus(self, status: bool) -> None:
        """The start button as an HMI sees it: true does what CycleStart(AUTOMATIC) does; false, its release, moves and stops nothing."""
        return self._call(calls.RMAC_CAM.SetCycleStartStatus(status))

    def GetCycleStartStatus(self) -> bool:
        """Whether the cycle is started."""
        return self._call(calls.RMAC_CAM.GetCycleStartStatus())

    def CycleStop(self, Mode: enums.CycleMode | int | str) -> bool:
        """Stops, whatever the mode, and keeps the rest of the queue; a new CycleStart goes on. On the path, as FeedHold."""
        return self._call(calls.RMAC_CAM.CycleStop(Mode))

    def SetCycleStopStatus(self, status: bool) -> None:
        """The stop button as an HMI sees it: true does what CycleStop does; false, its release, does not start anything."""
        return self._call(calls.RMAC_CAM.SetCycleStopStatus(status))

    def GetCycleStopStatus(self) -> bool:
        """Whether the cycle is stopped."""
        return self._call(calls.RMAC_CAM.GetCycleStopStatus())

    def StopNow(self) -> bool:
        """Stops as fast as the limits allow and empties the queue."""
        return self._call(calls.RMAC_CAM.StopNow())

    def FeedHold(self) -> bool:
        """Comes to rest on the path, or, where no plan for that is there within two cycles, joint by joint beside it (docs/safety.md); FeedResume goes on from there. The operator's also keeps everything from starting, at rest too, until an operator resumes."""
        return self._call(calls.RMAC_CAM.FeedHold())

    def FeedResume(self) -> bool:
        """Goes on after a FeedHold; from beside the path by way of where it was left, at 10 % of the joints' speeds. What the operator held only an operator resumes."""
        return self._call(calls.RMAC_CAM.FeedResume())

    def FeedRetrace(self, Distance: float) -> float:
        """Runs back along the path of what is held, then holds again; FeedResume runs forward from there. Distance: mm. Gives mm."""
        return self._call(calls.RMAC_CAM.FeedRetrace(Distance))

    def ParkProgram(self) -> bool:
        """Sets the program that is held aside, from its place on. The queue is empty then, spindle and coolant go off, and the machine may be jogged, measured with, and loaded in another role."""
        return self._call(calls.RMAC_CAM.ParkProgram())

    def TakeUpProgram(self) -> bool:
        """Queues the parked program again, in the part frame and with the tool in force now, and holds it; nothing moves before FeedResume, which switches spindle and coolant on again. The tool must stand within 1 mm of the place. When refused, the program stays parked."""
        return self._call(calls.RMAC_CAM.TakeUpProgram())

    def DropParkedProgram(self) -> bool:
        """Forgets the parked program."""
        return self._call(calls.RMAC_CAM.DropParkedProgram())

    def GetParkedProgram(self) -> dict[str, Any]:
        """The parked program: `mechanism`, `moves` to do, `move_id` and `s_mm` of the one that was begun, the `pose` in the part frame where it goes on, and how far the tool is `off_mm` it. Empty when none is parked."""
        return self._call(calls.RMAC_CAM.GetParkedProgram())

    def Reset(self) -> bool:
        """Leaves a fault or emergency stop whose cause is gone, takes over what an operator who has left holds, and clears the status codes; nothing moves by it."""
        return self._call(calls.RMAC_CAM.Reset())

    def SetFeedOverride(self, Percent: float) -> None:
        """Percentage of the programmed feed at which moves run, at once; 0 waits, and the 0 that an operator set only an operator raises. Percent: %."""
        return self._call(calls.RMAC_CAM.SetFeedOverride(Percent))

    def GetState(self) -> dict[str, Any]:
        """The machine's state now: what the topic `state` pushes."""
        return self._call(calls.RMAC_CAM.GetState())

    def GetCycleTimes(self) -> dict[str, Any]:
        """Where the servo thread's time goes, since the mechanism was put in: `deadline_misses`, and of `wake_up` (from when a cycle was due), `compute` (without the bus) and `bus` each `count`, `median_us`, `p99_us`, `p999_us`, `largest_us`, and `bins`, pairs of a bin's largest time in µs and how often it occurred."""
        return self._call(calls.RMAC_CAM.GetCycleTimes())

    def SetFeedrate(self, Feedrate: float) -> None:
        """Feed of the moves queued from now on; refused above the maximum. Feedrate: mm/min."""
        return self._call(calls.RMAC_CAM.SetFeedrate(Feedrate))

    def GetFeedrate(self) -> float:
        """Actual speed of the tool tip, from measured joints. Gives mm/min."""
        return self._call(calls.RMAC_CAM.GetFeedrate())

    def SetMaxFeedrate(self, MaxFeedrate: float) -> None:
        """Largest feed that SetFeedrate takes, at most the mechanism's own. MaxFeedrate: mm/min."""
        return self._call(calls.RMAC_CAM.SetMaxFeedrate(MaxFeedrate))

    def GetMaxFeedrate(self) -> float:
        """Largest feed that SetFeedrate takes. Gives mm/min."""
        return self._call(calls.RMAC_CAM.GetMaxFeedrate())

    def SetPathAccelRise(self, newVal: float) -> None:
        """Acceleration along the path while the feed rises, for moves queued from now on. newVal: mm/s²."""
        return self._call(calls.RMAC_CAM.SetPathAccelRise(newVal))

    def GetPathAccelRise(self) -> float:
        """What SetPathAccelRise set; 0 while the joints alone bound it. Gives mm/s²."""
        return self._call(calls.RMAC_CAM.GetPathAccelRise())

    def SetPathAccelFall(self, newVal: float) -> None:
        """Deceleration along the path while the feed falls, for moves queued from now on. newVal: mm/s²."""
        return self._call(calls.RMAC_CAM.SetPathAccelFall(newVal))

    def GetPathAccelFall(self) -> float:
        """What SetPathAccelFall set; 0 while the joints alone bound it. Gives mm/s²."""
        return self._call(calls.RMAC_CAM.GetPathAccelFall())

    def SetJointInterpSpeed(self, newVal: float) -> None:
        """Speed of joint moves and jogs, of each joint's speed limit. newVal: %."""
        return self._call(calls.RMAC_CAM.SetJointInterpSpeed(newVal))

    def GetJointInterpSpeed(self) -> float:
        """What SetJointInterpSpeed set. Gives %."""
        return self._call(calls.RMAC_CAM.GetJointInterpSpeed())

    def SetJointAccelRise(self, JointNum: int, newVal: float) -> None:
        """Acceleration of one joint in joint moves while its speed rises. newVal: mm/s² or deg/s²."""
        return self._call(calls.RMAC_CAM.SetJointAccelRise(JointNum, newVal))

    def GetJointAccelRise(self, JointNum: int) -> float:
        """What SetJointAccelRise set. Gives mm/s² or deg/s²."""
        return self._call(calls.RMAC_CAM.GetJointAccelRise(JointNum))

    def SetJointAccelFall(self, JointNum: int, newVal: float) -> None:
        """Deceleration of one joint in joint moves while its speed falls. newVal: mm/s² or deg/s²."""
        return self._call(calls.RMAC_CAM.SetJointAccelFall(JointNum, newVal))

    def GetJointAccelFall(self, JointNum: int) -> float:
        """What SetJointAccelFall set. Gives mm/s² or deg/s²."""
        return self._call(calls.RMAC_CAM.GetJointAccelFall(JointNum))

    def SetPathTolerance(self, Tolerance: float) -> None:
        """How far the path of moves queued from now on may be from what was programmed, so that corners, jumps of curvature and short lines are passed at speed. 0: an exact stop wherever the path is not smooth. Tolerance: mm."""
        return self._call(calls.RMAC_CAM.SetPathTolerance(Tolerance))

    def GetPathTolerance(self) -> float:
        """What SetPathTolerance set. Gives mm."""
        return self._call(calls.RMAC_CAM.GetPathTolerance())

    def SetOrientationTolerance(self, Tolerance: float) -> None:
        """How far the tool axis of moves queued from now on may be from what was programmed, beside SetPathTolerance of the tip; 0.1 unless set. 0: the axis is met exactly, so that the path stops wherever it does not turn smoothly. Tolerance: degrees."""
        return self._call(calls.RMAC_CAM.SetOrientationTolerance(Tolerance))

    def GetOrientationTolerance(self) -> float:
        """What SetOrientationTolerance set. Gives degrees."""
        return self._call(calls.RMAC_CAM.GetOrientationTolerance())

    def SetPartFrame(self, PartFrame: types.FrameLike) -> None:
        """Pose of the part frame in the machine frame, for the moves that follow. At rest. PartFrame: mm."""
        return self._call(calls.RMAC_CAM.SetPartFrame(PartFrame))

    def GetPartFrame(self) -> types.WireFrame:
        """What SetPartFrame set. Gives mm."""
        return self._call(calls.RMAC_CAM.GetPartFrame())

    def SetToolInterfaceFrame(self, ToolInterfaceFrame: types.FrameLike) -> None:
        """Pose of the tool tip on the tool interface. At rest. ToolInterfaceFrame: mm."""
        return self._call(calls.RMAC_CAM.SetToolInterfaceFrame(ToolInterfaceFrame))

    def GetToolInterfaceFrame(self) -> types.WireFrame:
        """What SetToolInterfaceFrame set. Gives mm."""
        return self._call(calls.RMAC_CAM.GetToolInterfaceFrame())

    def SetSpindleRPM(self, SpindleNumber: int, RPM: float) -> None:
        """Speed of a spindle; feed waits until it is reached. 0 stops it. RPM: rpm."""
        return self._call(calls.RMAC_CAM.SetSpindleRPM(SpindleNumber, RPM))

    def GetSpindleRPM(self, SpindleNumber: int) -> float:
        """Measured speed of a spindle. Gives rpm."""
        return self._call(calls.RMAC_CAM.GetSpindleRPM(SpindleNumber))

    def SetSpindleMaxRPM(self, SpindleNumber: int, MaxRPM: float) -> None:
        """Largest speed that SetSpindleRPM takes, at most the mechanism's own. MaxRPM: rpm."""
        return self._call(calls.RMAC_CAM.SetSpindleMaxRPM(SpindleNumber, MaxRPM))

    def GetSpindleMaxRPM(self, SpindleNumber: int) -> float:
        """Largest speed that SetSpindleRPM takes. Gives rpm."""
        return self._call(calls.RMAC_CAM.GetSpindleMaxRPM(SpindleNumber))

    def TurnCoolantOn(self) -> bool:
        """Switches the output Coolant on."""
        return self._call(calls.RMAC_CAM.TurnCoolantOn())

    def TurnCoolantOff(self) -> bool:
        """Switches the output Coolant off."""
        return self._call(calls.RMAC_CAM.TurnCoolantOff())

    def SetOutput(self, Name: str, On: bool) -> bool:
        """Switches an output of the machine by its name, at once; within a program InTurn does it in its turn. Name: of DigitalIOInterface/Outputs in device.json."""
        return self._call(calls.RMAC_CAM.SetOutput(Name, On))

    def SetAnimation(self, mode: bool) -> None:
        """True streams to this connection, for an animation, where each link of the machine stands (topic animation, 60 Hz; what there is to draw gives GetGeometry) and the joint values (topic joints, 50 Hz), or faster where it is subscribed to so; false ends it."""
        return self._call(calls.RMAC_CAM.SetAnimation(mode))

    def DoToolChange(self, ToolNumber: int) -> bool:
        """Changes the tool when the moves queued before it are done; moves queued after it are with the new tool. Without a changer the machine stops, spindle and coolant too, and waits for a person. ToolNumber: 0: an empty spindle."""
        return self._call(calls.RMAC_CAM.DoToolChange(ToolNumber))

    def ConfirmToolChange(self, ToolNumber: int) -> bool:
        """A person at the machine says that this tool is in the spindle: the one that was asked for, and the moves behind the change go on; or, when that is not known because a change was not completed, the one that is there. Whoever is connected may say it: it starts nothing that the holder of authority did not queue. ToolNumber: 0: an empty spindle."""
        return self._call(calls.RMAC_CAM.ConfirmToolChange(ToolNumber))

    def GetTools(self) -> dict[str, Any]:
        """The mechanism's tool table; the number of the tool in the spindle (0: none, null: not known) and of the one that the next queued change wants (null: none); and what a person was asked to do."""
        return self._call(calls.RMAC_CAM.GetTools())

    def SetTool(self, ToolNumber: int, Length: float, Radius: float | None = None, Name: str | None = None, Frame: types.FrameLike | None = None, MaxRPM: float | None = None, MaxTorque: float | None = None, NeedsSpindle: bool | None = None) -> None:
        """Adds a tool to the mechanism's table, or replaces the one of its number; of the tool in the spindle at rest, and in force at once. Length: mm. Radius: mm. Frame: mm; where it sits on the tool interface before its length: an angle head's turn; unturned unless given. MaxRPM: rpm; 0: as fast as the spindle can. MaxTorque: N·m; 0: not given; nobody watches it. NeedsSpindle: feed moves are refused while the spindle stands; true unless given."""
        return self._call(calls.RMAC_CAM.SetTool(ToolNumber, Length, Radius, Name, Frame, MaxRPM, MaxTorque, NeedsSpindle))

    def RemoveTool(self, ToolNumber: int) -> None:
        """Takes a tool out of the mechanism's table; not the one in the spindle."""
        return self._call(calls.RMAC_CAM.RemoveTool(ToolNumber))

    def SetSetup(self, Setup: Mapping[str, Any] | None = None) -> None:
        """Says what stands on the table: stock, part and fixtures, for SetCollisionCheck. All of it is in force, or nothing of it. Needs rest and an empty queue; loading or unloading a machine drops it. Setup: as setup.json, but for meshes, which have Points and Triangles instead of a File; null, or left out: nothing stands there, and the check is switched off."""
        return self._call(calls.RMAC_CAM.SetSetup(Setup))

    def GetSetup(self) -> dict[str, Any]:
        """What SetSetup set, as it was sent; empty: nothing is known of the table."""
        return self._call(calls.RMAC_CAM.GetSetup())

    def SetCollisionCheck(self, On: bool) -> None:
        """Switches the check of the path against the machine's bodies and the set-up on or off; off at first. While it is on nothing is planned that was not checked: the machine comes to rest before bodies come nearer to each other than the set-up's Clearance, and the event CollisionAhead says which. Needs rest and an empty queue."""
        return self._call(calls.RMAC_CAM.SetCollisionCheck(On))

    def GetCollisionCheck(self) -> bool:
        """Whether what moves is checked before it does."""
        return self._call(calls.RMAC_CAM.GetCollisionCheck())

    def SetLearnedOffsets(self, Learned: Mapping[str, Any] | None = None) -> None:
        """Has joints' servo laws make good what was learned of a program that is repeated, place by place on its path (docs/servo.md). Setpoints as they are told, watched and recorded stay the program's. Needs rest and an empty queue. Ends with motion authority, and when a machine is loaded, unloaded or configured. Learned: as rmac run --learn writes it; null, or left out: nothing is made good any more."""
        return self._call(calls.RMAC_CAM.SetLearnedOffsets(Learned))

    def GetLearnedOffsets(self) -> dict[str, Any]:
        """What there is to know for who learns a program: Machine, Configuration (changes with gains, filters, limits, …), Virtual, Period (s), of each of the Joints its Name, LargestOffset (mm or deg; 0: its drive closes its loop itself) and AnswerDelay (cycles); and how many Moves and Knots are in force."""
        return self._call(calls.RMAC_CAM.GetLearnedOffsets())

    def GetGeometry(self) -> dict[str, Any]:
        """What there is to draw of the loaded machine: the solids of its links, each with its pose while all joints stand at 0, names of links and joints, and where the tool interface is; `missing` says what is not known. Asked for once, and again when `geometry` in the topic animation is another number."""
        return self._call(calls.RMAC_CAM.GetGeometry())

    def GetMesh(self, Body: str) -> dict[str, Any]:
        """The surface of a body of GetGeometry that is a mesh, in mm: `Points` and `Triangles`. At most 50000 triangles, from a file of at most 16 MiB. Body: its Name."""
        return self._call(calls.RMAC_CAM.GetMesh(Body))

    def MoveAlongNurbsND(self, MoveID: int, NurbsND: types.NurbsLike) -> bool:
        """Queues a NURBS in joint space or with a tool axis; evaluated exactly, never cut into lines. MoveID: the client's number; comes back in events and records. NurbsND: mm or deg."""
        return self._call(calls.RMAC_CAM.MoveAlongNurbsND(MoveID, NurbsND))

    def MoveAlongNurbs(self, MoveID: int, Nurbs: types.NurbsLike) -> bool:
        """Queues a NURBS of the tool tip; the axis stays as it is when it begins. MoveID: the client's number; comes back in events and records. Nurbs: mm."""
        return self._call(calls.RMAC_CAM.MoveAlongNurbs(MoveID, Nurbs))

    def MoveAlongArc3(self, MoveID: int, ViaPoint: types.Vector, StartPoint: types.FrameLike, EndPoint: types.FrameLike) -> bool:
        """Queues a circular arc through a point. MoveID: the client's number; comes back in events and records. ViaPoint: mm. StartPoint: mm. EndPoint: mm."""
        return self._call(calls.RMAC_CAM.MoveAlongArc3(MoveID, ViaPoint, StartPoint, EndPoint))

    def MoveAlongArc(self, MoveID: int, RotSign: enums.RotSign | int | str, Closed: bool, CenterPoint: types.FrameLike, StartPoint: types.FrameLike, EndPoint: types.FrameLike, Turns: int | None = None) -> bool:
        """Queues a circular arc about the axis of CenterPoint; Closed makes it a full circle. Where EndPoint lies off its plane, along the axis, it is a helix of even pitch. MoveID: the client's number; comes back in events and records. CenterPoint: mm. StartPoint: mm. EndPoint: mm. Turns: whole turns more."""
        return self._call(calls.RMAC_CAM.MoveAlongArc(MoveID, RotSign, Closed, CenterPoint, StartPoint, EndPoint, Turns))

    def MoveAlongLine(self, MoveID: int, StartPoint: types.FrameLike, EndPoint: types.FrameLike) -> bool:
        """Queues a straight line; the tool axis turns evenly along it. MoveID: the client's number; comes back in events and records. StartPoint: mm. EndPoint: mm."""
        return self._call(calls.RMAC_CAM.MoveAlongLine(MoveID, StartPoint, EndPoint))

    def MoveToPathTarget(self, MoveID: int, TargetFrame: types.FrameLike) -> bool:
        """Queues a positioning move: the tool tip on a line from where the queue ends, from rest to rest. MoveID: the client's number; comes back in events and records. TargetFrame: mm."""
        return self._call(calls.RMAC_CAM.MoveToPathTarget(MoveID, TargetFrame))

    def MoveToJointTarget(self, MoveID: int, JointTargetFrame: types.FrameLike | types.Joints) -> bool:
        """Queues a positioning move: all joints together, from rest to rest. MoveID: the client's number; comes back in events and records. JointTargetFrame: mm or deg; a frame, or {"joints": [...]}."""
        return self._call(calls.RMAC_CAM.MoveToJointTarget(MoveID, JointTargetFrame))

    def Dwell(self, MoveID: int, Time: float) -> bool:
        """Queues a rest of so long (G4). Time that the program is held does not count. MoveID: the client's number; comes back in events and records. Time: s."""
        return self._call(calls.RMAC_CAM.Dwell(MoveID, Time))

    def ProgramStop(self, MoveID: int, Optional: bool | None = None, Message: str | None = None) -> bool:
        """Queues a stop (M0; optional: M1): the program is held at rest there, the event ProgramStopped tells why, and FeedResume goes on. Spindle and outputs stay as they are. MoveID: the client's number; comes back in events and records. Optional: true: passed over unless SetOptionalStop switched optional stops on before its turn comes. Message: for the person at the machine, at most 200 bytes."""
        return self._call(calls.RMAC_CAM.ProgramStop(MoveID, Optional, Message))

    def AwaitInput(self, MoveID: int, Name: str, On: bool, TimeOut: float) -> bool:
        """Queues a rest until a named input of the machine is on, or off. When it is not within the time-out, the program is held, and ProgramStopped tells what it waited for; FeedResume waits once more. In virtual mode every input is as it is waited for. MoveID: the client's number; comes back in events and records. Name: of DigitalIOInterface/Inputs in device.json. TimeOut: s."""
        return self._call(calls.RMAC_CAM.AwaitInput(MoveID, Name, On, TimeOut))

    def InTurn(self, MoveID: int, Calls: Sequence[Mapping[str, Any]]) -> bool:
        """Queues calls between moves: `SetSpindleRPM`, `TurnCoolantOn`, `TurnCoolantOff`, `SetOutput`, made in their order when the moves before them are done. What follows waits for the spindles' speeds. MoveID: the client's number; comes back in events and records. Calls: each `{"method", "params"}`, as it would be sent."""
        return self._call(calls.RMAC_CAM.InTurn(MoveID, Calls))

    def SetOptionalStop(self, On: bool) -> None:
        """Switches optional stops on or off, as the switch on a panel does; off at first. A stop whose turn comes afterwards goes by it."""
        return self._call(calls.RMAC_CAM.SetOptionalStop(On))

    def GetOptionalStop(self) -> bool:
        """What SetOptionalStop set."""
        return self._call(calls.RMAC_CAM.GetOptionalStop())

    def CurrentPosition(self) -> list[float]:
        """Measured joint positions, joint 0 first. Gives mm or deg."""
        return self._call(calls.RMAC_CAM.CurrentPosition())

    def NumMovesInBuffer(self) -> int:
        """Moves queued and not yet done."""
        return self._call(calls.RMAC_CAM.NumMovesInBuffer())

    @overload
    def StatusMajorCode(self) -> enums.StatusMajorCode: ...
    @overload
    def StatusMajorCode(self, newVal: enums.StatusMajorCode | int | str) -> bool: ...
    def StatusMajorCode(self, newVal: enums.StatusMajorCode | int | str | None = None) -> Any:
        """Whether the machine met an error since the code was cleared."""
        if newVal is None:
            return self._call(calls.RMAC_CAM.StatusMajorCode())
        return self._call(calls.RMAC_CAM.StatusMajorCode(newVal))

    @overload
    def StatusMinorCode(self) -> enums.StatusMinorCode: ...
    @overload
    def StatusMinorCode(self, newVal: enums.StatusMinorCode | int | str) -> bool: ...
    def StatusMinorCode(self, newVal: enums.StatusMinorCode | int | str | None = None) -> Any:
        """Which error the machine met last."""
        if newVal is None:
            return self._call(calls.RMAC_CAM.StatusMinorCode())
        return self._call(calls.RMAC_CAM.StatusMinorCode(newVal))

    def Ok(self) -> bool:
        """True when the machine met no error since the status codes were cleared."""
        return self._call(calls.RMAC_CAM.Ok())

    def LastHitPosition(self) -> list[float]:
        """Joint positions at the last hit of the probe. Gives mm or deg."""
        return self._call(calls.RMAC_CAM.LastHitPosition())

    @overload
    def ControlMode(self) -> enums.ControlMode: ...
    @overload
    def ControlMode(self, newVal: enums.ControlMode | int | str) -> bool: ...
    def ControlMode(self, newVal: enums.ControlMode | int | str | None = None) -> Any:
        """What the measuring machine is doing."""
        if newVal is None:
            return self._call(calls.RMAC_CAM.ControlMode())
        return self._call(calls.RMAC_CAM.ControlMode(newVal))

    @overload
    def Parameter(self, ParamNumber: enums.ParamNumber | int | str) -> float: ...
    @overload
    def Parameter(self, ParamNumber: enums.ParamNumber | int | str, newVal: float) -> bool: ...
    def Parameter(self, ParamNumber: enums.ParamNumber | int | str, newVal: float | None = None) -> Any:
        """A distance or speed of probing. newVal: mm or mm/s. Gives mm or mm/s."""
        if newVal is None:
            return self._call(calls.RMAC_CAM.Parameter(ParamNumber))
        return self._call(calls.RMAC_CAM.Parameter(ParamNumber, newVal))

    def NewHit(self) -> bool:
        """Whether the probe was hit since the positions were read last."""
        return self._call(calls.RMAC_CAM.NewHit())

    def ProbeActive(self) -> bool:
        """Whether the probe has power and answers."""
        return self._call(calls.RMAC_CAM.ProbeActive())

    def Home(self) -> bool:
        """Has the drives look for home that device.json gives a HomingTurn; where there are none, moves all joints to their home position, zero. From rest."""
        return self._call(calls.RMAC_CAM.Home())

    def MoveToXYZ(self, MoveID: int, x: float, y: float, z: float, Speed: float) -> bool:
        """Moves the tip to a point at a speed. MoveID: the client's number; comes back in events and records. x: mm. y: mm. z: mm. Speed: mm/s."""
        return self._call(calls.RMAC_CAM.MoveToXYZ(MoveID, x, y, z, Speed))

    def MoveRotaryAxis(self, MoveID: int, JointNum: int, JointPose: float, Direction: enums.Direction | int | str, Speed: float) -> bool:
        """Turns one rotary joint to a position. MoveID: the client's number; comes back in events and records. JointPose: deg. Speed: deg/s."""
        return self._call(calls.RMAC_CAM.MoveRotaryAxis(MoveID, JointNum, JointPose, Direction, Speed))

    def AutoMeasure(self, MoveID: int, x: float, y: float, z: float, Speed: float) -> bool:
        """Moves towards a point until the probe is hit, then backs off. MoveID: the client's number; comes back in events and records. x: mm. y: mm. z: mm. Speed: mm/s."""
        return self._call(calls.RMAC_CAM.AutoMeasure(MoveID, x, y, z, Speed))

    def MoveInArc(self, MoveID: int, x: float, y: float, z: float, CenterX: float, CenterY: float, CenterZ: float, i: float, j: float, k: float, Speed: float) -> bool:
        """Moves on an arc from the present position to a point. MoveID: the client's number; comes back in events and records. x: mm. y: mm. z: mm. CenterX: mm. CenterY: mm. CenterZ: mm. Speed: mm/s."""
        return self._call(calls.RMAC_CAM.MoveInArc(MoveID, x, y, z, CenterX, CenterY, CenterZ, i, j, k, Speed))

    def MoveAllAxis(self, MoveID: int, Position: types.Numbers, LinearSpeed: float) -> bool:
        """Moves all joints to their positions at a speed. MoveID: the client's number; comes back in events and records. Position: mm or deg. LinearSpeed: mm/s."""
        return self._call(calls.RMAC_CAM.MoveAllAxis(MoveID, Position, LinearSpeed))

    def SendConditionChangedEvent(self, JointValues: types.Numbers, NumJoints: int, Mask: int | str, Condition: int | str) -> bool:
        """In virtual mode: the probe is deflected with the joints there, or lets go. JointValues: mm or deg. Mask: bit 0: the probe. Condition: bit 0: it touches."""
        return self._call(calls.RMAC_CAM.SendConditionChangedEvent(JointValues, NumJoints, Mask, Condition))

    def SetCalibratedPartFrame(self) -> bool:
        """Puts the part frame where the tool tip is, its Z along the tool axis, at rest: the tip's pose reads zero there. CurrentPosition goes on to give the joints' own values (docs/decisions/0011)."""
        return self._call(calls.RMAC_CAM.SetCalibratedPartFrame())

    def ManualMeasure(self) -> bool:
        """Lets a person jog the probe and expects hits, which end the jog, or a move and what is queued behind it."""
        return self._call(calls.RMAC_CAM.ManualMeasure())

    def SpinProbe(self, RPM: float, Seconds: float) -> bool:
        """Spins the probe for a time. RPM: rpm. Seconds: s."""
        return self._call(calls.RMAC_CAM.SpinProbe(RPM, Seconds))

    def JogJoint(self, JntNum: int, Distance: float | None = None, Velocity: float | None = None) -> bool:
        """Moves one joint from rest: by a distance at the joint interpolation speed, or at a velocity for 200 ms, on and on while it is sent again. Distance: mm or deg. Velocity: mm/s or deg/s; 0 stops; instead of Distance."""
        return self._call(calls.RMAC_CAM.JogJoint(JntNum, Distance, Velocity))

    def JogPath(self, Direction: types.Vector, Distance: float | None = None, Velocity: float | None = None, InToolFrame: bool | None = None) -> bool:
        """Moves the tool tip straight from rest, the tool axis staying as it is: by a distance at the feed in force, or at a velocity for 200 ms, on and on while it is sent again. Direction: mm. Distance: mm. Velocity: mm/s; 0 stops; instead of Distance. InToolFrame: the direction is the tool's, Z along its axis; else the part's."""
        return self._call(calls.RMAC_CAM.JogPath(Direction, Distance, Velocity, InToolFrame))

    def MoveToReferencePoint(self) -> bool:
        """Moves the tip straight to the zero of the part frame, from rest."""
        return self._call(calls.RMAC_CAM.MoveToReferencePoint())

    def SetJointForce(self, JntNum: int, Force: float) -> bool:
        """Contact force that a joint under force control keeps. Force: N or N·m; 0: hold the position; positive pushes towards larger positions."""
        return self._call(calls.RMAC_CAM.SetJointForce(JntNum, Force))


class FlightRecorder:
    def __init__(self, call: BlockingCaller) -> None:
        self._call = call

    def Record(self) -> str:
        """Has the last seconds of every servo cycle written to a file, and gives its name. An event tells when it is there (FlightRecord), or why not (FlightRecordFailed)."""
        return self._call(calls.FlightRecorder.Record())

    def List(self) -> dict[str, Any]:
        """The flight records that there are, as `records`, oldest first; of each `name`, `cause` (fault, demand), `message`, `cycle`, `t_s`, `utc`, `mechanism`, `joints`, `first_cycle`, `last_cycle`, `bytes`."""
        return self._call(calls.FlightRecorder.List())

    def Read(self, Name: str, Offset: int | None = None) -> dict[str, Any]:
        """A part of a flight record's text: `text`, `next_offset` to go on with (null at the end), and `bytes`, the size of the whole. The first line is a JSON object, the rest CSV. Offset: bytes; 0 when left out."""
        return self._call(calls.FlightRecorder.Read(Name, Offset))


class Bus:
    def __init__(self, call: BlockingCaller) -> None:
        self._call = call

    def GetState(self) -> dict[str, Any]:
        """What the buses that run went through since they were started. `buses`: of each CANopen `interface`, its counts, whether it is `bus_off` or `link_down`, its `controller` with `state` and error counters (null: it has none, or does not tell), and its `nodes` with `state`, `problem` (null: none), how often they were `lost` and `recovered`, `missed_answers`, jitter, and the latest `emergencies` and `aborts`, newest first. `lines`: of each Modbus `endpoint`, its `units` with `state`, requests and what came of them, `exceptions` by code, and the `last_trouble` (null: none)."""
        return self._call(calls.Bus.GetState())


class Connection:
    def __init__(self, call: BlockingCaller) -> None:
        self._call = call

    def hello(self, client: str, version: str | None = None) -> dict[str, Any]:
        """Tells who calls, and asks who answers: name, version, units and limits. Optional, and good manners."""
        return self._call(calls.Connection.hello(client, version))

    def subscribe(self, topics: Sequence[str], rate_hz: float | None = None) -> bool:
        """Pushes topics to this connection: state, joints, drives, animation, events. rate_hz: Hz; 100 when left out; more for one client at a time."""
        return self._call(calls.Connection.subscribe(topics, rate_hz))

    def unsubscribe(self, topics: Sequence[str] | None = None) -> bool:
        """Ends the pushing of topics; of all when none is named."""
        return self._call(calls.Connection.unsubscribe(topics))

    def discover(self) -> dict[str, Any]:
        """This API as an OpenRPC document."""
        return self._call(calls.Connection.discover())


class Lease:
    def __init__(self, call: BlockingCaller) -> None:
        self._call = call

    def acquire(self) -> dict[str, Any]:
        """Takes motion authority, the lease that moving needs; one client at a time holds it. Gives `timeout_s`, the silence after which the lease ends (0: never), and `dropped_moves`, how many moves were dropped from the queue when the lease before it ended."""
        return self._call(calls.Lease.acquire())

    def renew(self) -> bool:
        """Confirms that this connection still holds motion authority; like any request, it keeps the lease from ending."""
        return self._call(calls.Lease.renew())

    def release(self) -> bool:
        """Gives motion authority back. As when a lease is lost, a machine that moves is stopped, and what is queued is dropped."""
        return self._call(calls.Lease.release())


class Post:
    def __init__(self, call: BlockingCaller) -> None:
        self._call = call

    def acquire(self) -> dict[str, Any]:
        """Takes the operator's place beside the holder of authority, or together with authority; one client at a time has it. Its holder may set the feed override, resume and retrace, and what it holds by FeedHold, or by an override of 0, only an operator resumes. Gives `name`, and `held_by`, who holds the machine as operator already, or empty."""
        return self._call(calls.Post.acquire())

    def release(self) -> bool:
        """Gives the operator's place up, as the end of its connection does. Nothing moves or stops by it; what is held stays held until the next operator resumes it, or the holder of authority after a Reset."""
        return self._call(calls.Post.release())


class Methods:
    """Every method, by the interface that it belongs to."""

    def __init__(self, call: BlockingCaller) -> None:
        self.drivers = DeviceDriverManager(call)
        self.device = Device(call)
        self.config = RMAC_Config(call)
        self.cam = RMAC_CAM(call)
        self.recorder = FlightRecorder(call)
        self.bus = Bus(call)
        self.connection = Connection(call)
        self.lease = Lease(call)
        self.post = Post(call)
