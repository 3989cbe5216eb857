"""The machines that an appliance knows, and the characteristics of the one that is loaded."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from dataclasses import dataclass
from typing import Any

from rmac.generated.calls import Device, DeviceDriverManager
from rmac.generated.enums import JointType
from rmac.wire.call import Call

# What is asked step by step: each step's calls are sent together, and its answers come back. A blocking client drives it
# as an asyncio one does.
Steps = Generator[Sequence[Call[Any]], list[Any], Any]


@dataclass(frozen=True, slots=True)
class Machine:
    """A row of the device driver database."""

    name: str
    id: int
    driver: str
    driver_version: int
    type: str
    configuration: str
    joints: int
    working_volume_mm: tuple[float, ...]  # length, width, depth
    spindle_hp: float
    spindle_max_rpm: float
    spindle_max_torque_nm: float
    max_feed_mm_min: float
    max_pallet_load_kg: float
    positioning_tolerance_mm: float
    repeatability_tolerance_mm: float


@dataclass(frozen=True, slots=True)
class Joint:
    """Lengths in mm, or degrees where it turns."""

    number: int
    type: JointType
    lowest: float
    highest: float
    max_speed: float
    max_acceleration: float
    max_jerk: float
    servo_law: str


@dataclass(frozen=True, slots=True)
class LoadedMachine:
    name: str
    kinematics: str
    actuator_map: str
    configuration: str
    working_volume_mm: tuple[float, ...]
    max_feed_mm_min: float
    spindle_max_rpm: float
    joints: tuple[Joint, ...]


def _volume(text: str) -> tuple[float, ...]:
    return tuple(float(part) for part in text.split("x") if part)


def find_machines(where: str) -> Steps:
    """The rows that an SQL condition on DeviceDrivers finds; all where it is empty."""
    manager = DeviceDriverManager
    first: list[Call[Any]] = [manager.OpenDeviceDriverDatabase()]
    if where:
        first.append(manager.SearchDatabaseRecordSet(f"SELECT * FROM DeviceDrivers WHERE {where}"))
    else:
        first.append(manager.GetTotalNumberOfRecords())
    _, count = yield first
    found = []
    for number in range(count):
        asked: list[Call[Any]] = [] if number == 0 else [manager.OnNextRecord()]
        asked += [
            manager.Machine_GetMechanismName(), manager.Machine_GetMechanismID(), manager.Machine_GetMechanismDeviceDriver(),
            manager.Machine_GetMechanismDeviceDriverVersion(), manager.Machine_GetMechanismType(),
            manager.Machine_GetMechanismConfigurationType(), manager.Machine_GetMechanismNumberOfJoints(),
            manager.Machine_GetMechanismWorkingVolume(), manager.Machine_GetMechanismSpindleHorsePower(),
            manager.Machine_GetMechanismSpindleMaxSpeed(), manager.Machine_GetMechanismSpindleMaxTorque(),
            manager.Machine_GetMechanismMaxFeedrate(), manager.Machine_GetMechanismMaxPalletLoad(),
            manager.Machine_GetMechanismPositioningTolerance(), manager.Machine_GetMechanismRepeatabilityTolerance(),
        ]  # fmt: skip
        answers = (yield asked)[-15:]
        answers[7] = _volume(answers[7])
        found.append(Machine(*answers))
    yield [manager.CloseDeviceDriverDatabase()]
    return found


def describe_loaded() -> Steps:
    """The loaded machine with its joints; refused where none is loaded."""
    _, name, kinematics, actuator_map, configuration, volume, feed, rpm, joints = yield [
        Device.OpenDeviceDatabase(), Device.Machine_GetMechanismName(), Device.Machine_GetMechanismKinematics(),
        Device.Machine_GetMechanismActuatorMap(), Device.Machine_GetMechanismConfiguration(),
        Device.Machine_GetMechanismWorkingVolume(), Device.Machine_GetMechanismMaxFeedrate(),
        Device.Machine_GetMechanismSpindleMaxSpeed(), Device.Machine_GetMechanismNumberOfJoints(),
    ]  # fmt: skip
    each = []
    for number in range(joints):
        answers = yield [
            Device.Machine_GetMechanismJntTypes(number), Device.Machine_GetMechanismJntMinLimit(number),
            Device.Machine_GetMechanismJntMaxLimit(number), Device.Machine_GetMechanismJntMaxSpeed(number),
            Device.Machine_GetMechanismJntMaxAccel(number), Device.Machine_GetMechanismJntMaxJerk(number),
            Device.Machine_GetMechanismJntServoControlLaw(number),
        ]  # fmt: skip
        each.append(Joint(number, *answers))
    return LoadedMachine(name, kinematics, actuator_map, configuration, _volume(volume), feed, rpm, tuple(each))
