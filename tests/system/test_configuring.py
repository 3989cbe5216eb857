"""RMAC_Config makes another machine of the one that is loaded: modules with parameters, drives on other buses, more or fewer joints."""

import shutil
import unittest

from appliance import BUILD, Appliance, run_to_rest

PLANE = {"kinematics": {"DMACKin": "ChainKinematics", "Parameters": {"joints": "X Y"}},
         "map": {"DMACMachineActMap": "TransmissionMap",
                 "Parameters": {"transmissions": "screw screw", "t1": [5, 1], "t2": [5, 1]}}}


class Configuring(unittest.TestCase):
    def setUp(self):
        self.appliance = self.enterContext(Appliance(own_tree=True))
        self.operator = self.appliance.operator("DMACXYZ")

    def config(self, function, **params):
        self.operator.call("RMAC_Config." + function, **params)

    def apply(self):
        self.operator.call("RMAC_Config.Apply")

    def becomes_a_plane(self):
        self.config("SetMechanismKinematics", **PLANE["kinematics"])
        self.config("SetMechanismActuatorMap", **PLANE["map"])
        self.config("SetMechanismNumJnts", NumJnts=2)
        self.config("SetMechanismNumActuators", NumActuators=2)

    def moves_to(self, *joints):
        self.operator.call("RMAC_CAM.MoveToJointTarget", MoveID=1, JointTargetFrame={"joints": list(joints)})
        return run_to_rest(self.operator)["joints"]

    def test_fewer_joints_and_more_again(self):
        self.becomes_a_plane()
        self.apply()
        plane = self.moves_to(3, 4)
        self.assertEqual(len(plane), 2)
        self.assertAlmostEqual(plane[1], 4, delta=0.05)
        # The third comes back as device.json has it.
        self.config("SetMechanismKinematics", DMACKin="ChainKinematics", Parameters={"joints": "X Y Z"})
        self.config("SetMechanismActuatorMap", DMACMachineActMap="DMACXYZMachineActMap",
                    Parameters={"pitch_mm": [5, 5, 5], "gear_ratio": [1, 1, 1]})
        self.config("SetMechanismNumJnts", NumJnts=3)
        self.config("SetMechanismNumActuators", NumActuators=3)
        self.apply()
        whole = self.moves_to(3, 4, -2)
        self.assertEqual(len(whole), 3)
        self.assertAlmostEqual(whole[2], -2, delta=0.05)

    def test_a_joint_that_no_file_describes(self):
        """A table that turns, with its own drive: four joints of three."""
        self.config("SetMechanismKinematics", DMACKin="ChainKinematics", Parameters={"joints": "X Y Z A"})
        self.config("SetMechanismActuatorMap", DMACMachineActMap="TransmissionMap",
                    Parameters={"transmissions": "screw screw screw gear", "t1": [5, 1], "t2": [5, 1], "t3": [5, 1], "t4": 90})
        self.config("SetMechanismNumJnts", NumJnts=4)
        self.config("SetMechanismJointName", JntNum=3, Name="A")
        self.config("SetMechanismJointType", JntNum=3, JointType="DMAC_ROT_JNT")
        self.config("SetMechanismJointLimitType", JntNum=3, JointLimitType="DMAC_LIMITED_JNT")
        for value, setter in ((90, "MaximumLimit"), (-90, "MinimumLimit"), (30, "MaximumSpeed"), (200, "MaximumAcceleration"), (2000, "MaximumJerk")):
            parameter = {"MaximumLimit": "MaxJntLimit", "MinimumLimit": "MinJntLimit", "MaximumSpeed": "MaxJntSpeed",
                         "MaximumAcceleration": "MaxJntAccel", "MaximumJerk": "MaxJntJerk"}[setter]
            self.config("SetMechanismJoint" + setter, JntNum=3, **{parameter: value})
        self.config("SetMechanismJointServoControlLaw", JntNum=3, ControlLaw="DMAC_PID_CONTROL", Parameters={"rest_band": 0.002})
        self.config("SetMechanismJointServoControlGains", JntNum=3, ServoControlGains=[139.1, 12510, 0.9932])
        self.config("SetMechanismJointWatch", JntNum=3, MaxFollowingError=0.5, MaxEffort=60)
        message = self.operator.refusal("RMAC_Config.SetMechanismNumActuators", NumActuators=4, Buses=[{}, {}, {}]).message
        self.assertIn("there are 3", message)
        message = self.operator.refusal("RMAC_Config.SetMechanismNumActuators", NumActuators=4, Buses=[{}, {}, {}, {"Bus": "sim0"}]).message
        self.assertIn("/3", message)
        self.config("SetMechanismNumActuators", NumActuators=4,
                    Buses=[{}, {}, {}, {"Bus": "sim0", "Axis": 5, "CountsPerRevolution": 131072, "RatedTorque": 0.318}])
        self.apply()
        self.assertAlmostEqual(self.moves_to(1, 2, 3, 30)[3], 30, delta=0.1)

    def test_a_second_spindle(self):
        second = {"Bus": "sim0", "Axis": 5, "MaxSpeed": 500, "MaxTorque": 0.9, "HorsePower": 0.05, "RatedTorque": 0.318,
                  "CountsPerRevolution": 131072, "MaxAcceleration": 2000, "ServoControlLaw": {"Module": "PIDServoControlLaw"},
                  "Gains": [0.0005, 0.01, 0]}
        self.config("SetMechanismNumSpindle", NumSpindle=2, Buses=[{}, second])
        self.apply()
        self.operator.call("RMAC_CAM.SetSpindleRPM", SpindleNumber=1, RPM=300)
        self.operator.call("subscribe", topics=["state"], rate_hz=100)
        turning = self.operator.wait_note("state", lambda state: abs(state["spindle_rpm"][1] - 300) < 20)
        self.assertLess(abs(turning["spindle_rpm"][0]), 1)

    def test_what_is_drafted_is_verified_before_it_goes_live(self):
        shutil.copy(BUILD / "bad_modules" / "LiesAboutInverse" / "BadKinematics.so", self.appliance.tree / "modules")
        self.config("SetMechanismKinematics", DMACKin="BadKinematics")
        message = self.operator.refusal("RMAC_Config.Apply").message
        for word in ("verification", "BadKinematics", "off the pose"):
            self.assertIn(word, message)
        self.assertAlmostEqual(self.moves_to(0, 0, 2)[2], 2, delta=0.05)

    def refused_and_unchanged(self, word):
        message = self.operator.refusal("RMAC_Config.Apply").message
        self.assertIn(word, message)
        self.assertAlmostEqual(self.moves_to(0, 0, 2)[2], 2, delta=0.05)

    def test_parameters_and_buses_reach_the_interface_to_the_drives(self):
        self.config("SetMechanismDigitalControlInterface", DigitalControlInterface="CANopenInterface",
                    Parameters={"gone0.node": [1, 2, 3], "gone0.mode": [10, 10, 10]})
        self.config("SetMechanismNumActuators", NumActuators=3, Buses=[{"Bus": "gone0", "Axis": axis} for axis in range(3)])
        self.config("SetMechanismNumSpindle", NumSpindle=0)
        self.refused_and_unchanged("gone0")

    def test_parameters_reach_the_interface_to_inputs_and_outputs(self):
        refused = self.operator.refusal("RMAC_Config.SetMechanismDigitalIOInterface", DigitalIOInterface="GPIOInterface",
                                        Parameters={"chip": {"deep": 1}})
        self.assertIn("/chip", refused.message)
        self.config("SetMechanismDigitalIOInterface", DigitalIOInterface="GPIOInterface", Parameters={"chip": "gone9", "input_0": "estop"})
        self.refused_and_unchanged("gone9")


if __name__ == "__main__":
    unittest.main()
