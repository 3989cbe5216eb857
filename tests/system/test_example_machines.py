"""The machines of docs/examples that are no chains, built outside of the tree against an installation, cut along the curves of their programs.
Where the tool is follows here from the joints by geometry of our own, which shares nothing with the modules."""

import json
import math
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

from appliance import BUILD, SOURCE, Appliance, pose, run_to_rest, wait_for_rest

EXAMPLES = SOURCE / "docs/examples"
KINEMATICS_BOUND_MM, PATH_BOUND_MM = 1e-6, 0.05


def delta_residual(joints, tip):
    """By how much the arms' lengths are missed where the hub is at the tip; rails and arms as in device.json."""
    radius, arm = 120, 250
    worst = 0
    for i, joint in enumerate(joints):
        angle = math.radians(90 + 120 * i)
        foot = (radius * math.cos(angle), radius * math.sin(angle), joint + math.sqrt(arm ** 2 - radius ** 2))
        worst = max(worst, abs(math.dist(foot, tip) - arm))
    return worst


def arm_residual(joints, tip):
    """By how much the tip is missed by a walk from the base to the hand, each joint turning what is beyond it."""
    waist, shoulder, elbow, forearm, wrist, _ = map(math.radians, joints)

    def about_x(angle, v):
        return (v[0], math.cos(angle) * v[1] - math.sin(angle) * v[2], math.sin(angle) * v[1] + math.cos(angle) * v[2])

    def about_y(angle, v):
        return (math.cos(angle) * v[0] + math.sin(angle) * v[2], v[1], math.cos(angle) * v[2] - math.sin(angle) * v[0])

    def about_z(angle, v):
        return (math.cos(angle) * v[0] - math.sin(angle) * v[1], math.sin(angle) * v[0] + math.cos(angle) * v[1], v[2])

    def lifted(by, v):
        return tuple(a + b for a, b in zip(by, v))

    at = about_x(forearm, about_y(wrist, (0, 0, -60)))
    at = about_y(elbow, lifted((220, 0, 0), at))
    at = about_y(shoulder, lifted((0, 0, 250), at))
    at = about_z(waist, lifted((0, 0, 300), at))
    return math.dist(at, tip)


def spline(nurbs, count=4000):
    """Points of a B-spline by de Boor's algorithm."""
    p, knots, points = nurbs["degree"], nurbs["knots"], nurbs["points"]
    result = []
    for i in range(count + 1):
        u = knots[p] + (knots[-p - 1] - knots[p]) * i / count
        k = max(j for j in range(p, len(points)) if knots[j] <= u)
        d = [list(map(float, points[j + k - p])) for j in range(p + 1)]
        for r in range(1, p + 1):
            for j in range(p, r - 1, -1):
                a = (u - knots[j + k - p]) / (knots[j + 1 + k - r] - knots[j + k - p])
                d[j] = [(1 - a) * x + a * y for x, y in zip(d[j - 1], d[j])]
        result.append(tuple(d[p]))
    return result


def off(move, tip):
    """How far a tip is off the curve of a move."""
    method, params = move
    if method.endswith("Nurbs"):
        return min(math.dist(point, tip) for point in params["curve"])
    start, end = params["StartPoint"]["p"], params["EndPoint"]["p"]
    if method.endswith("Line"):
        way = [b - a for a, b in zip(start, end)]
        part = sum((c - a) * w for a, c, w in zip(start, tip, way)) / sum(w * w for w in way)
        return math.dist(tip, [a + min(max(part, 0), 1) * w for a, w in zip(start, way)])
    center = params["CenterPoint"]["p"]  # its axis is z, and it has half a turn
    return math.hypot(math.dist(tip[:2], center[:2]) - math.dist(start[:2], center[:2]), tip[2] - start[2])


class ExampleMachines(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        prefix = cls.folder / "usr"
        subprocess.run(["cmake", "--install", BUILD, "--prefix", prefix], check=True, stdout=subprocess.DEVNULL)
        (cls.tree,) = prefix.glob("lib/**/rmac/drivers")
        environment = os.environ | {"CMAKE_PREFIX_PATH": str(prefix)}
        for example in ("linear-delta", "six-joint-arm"):
            work = cls.folder / example
            shutil.copytree(EXAMPLES / example, work)
            for command in (["cmake", "-B", "build", f"-DCMAKE_INSTALL_PREFIX={prefix}"], ["cmake", "--build", "build"],
                            ["cmake", "--install", "build"]):
                subprocess.run(command, cwd=work, env=environment, check=True, stdout=subprocess.DEVNULL)
        cls.program = prefix / "sbin/rmacd"

    def operator(self, machine):
        self.appliance = self.enterContext(Appliance(program=self.program, device_tree=str(self.tree)))
        client = self.appliance.client("operator")
        client.call("authority.acquire")
        client.call("Device.Load", Name=machine)
        return client

    def cut(self, machine, example, residual):
        """Runs the example's program; every sample's pose follows from its joints, and is on the curve. The states."""
        operator = self.operator(machine)
        moves = {}
        watcher = self.appliance.client("watcher")
        watcher.call("subscribe", topics=["state"], rate_hz=1000)
        for text in (EXAMPLES / example / "program.rmac").read_text().splitlines():
            request = json.loads(text)
            if not request["method"].startswith("RMAC_CAM."):
                continue
            operator.call(request["method"], **request.get("params", {}))
            if "MoveID" in request.get("params", {}):
                moves[request["params"]["MoveID"]] = (request["method"], request["params"])
                if "Nurbs" in request["params"]:
                    request["params"]["curve"] = spline(request["params"]["Nurbs"])
        operator.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")
        states = []
        while not states or states[-1]["moving"] or states[-1]["moves_in_buffer"] > 0 or states[-1]["move_id"] != max(moves):
            states.append(watcher.wait_note("state"))
        wait_for_rest(operator)
        operator.call("RMAC_CAM.CycleStop", Mode="AUTOMATIC")
        seen = set()
        for state in states:
            tip = state["pose"][:3]
            self.assertLess(residual(state["joints"], tip), KINEMATICS_BOUND_MM)
            move = moves.get(state["move_id"])
            if not state["moving"] or move is None or move[0].endswith("JointTarget"):
                continue
            seen.add(state["move_id"])
            self.assertLess(off(move, tip), PATH_BOUND_MM, (state["move_id"], tip))
        self.assertEqual(seen, {number for number, move in moves.items() if not move[0].endswith("JointTarget")})
        self.assertGreater(len(states), 500)
        return operator, states

    def test_delta_cuts_its_curves_and_knows_where_its_tool_is_not(self):
        operator, _ = self.cut("LinearDelta", "linear-delta", delta_residual)
        refusal = operator.refusal("RMAC_CAM.MoveToJointTarget", MoveID=9, JointTargetFrame={"joints": [150, -150, -150]})
        for word in ("no pose", "TowerA", "nothing was queued"):
            self.assertIn(word, refusal.message)
        operator.call("RMAC_CAM.MoveToJointTarget", MoveID=9, JointTargetFrame={"joints": [0, -150, -150]})
        run_to_rest(operator)
        operator.call("RMAC_CAM.CycleStop", Mode="AUTOMATIC")
        refusal = operator.refusal("RMAC_CAM.JogJoint", JntNum=0, Distance=150)
        self.assertIn("no pose", refusal.message)
        far = operator.state()["pose"][:3]
        refusal = operator.refusal("RMAC_CAM.MoveToPathTarget", MoveID=9, TargetFrame=pose(far[0] + 400, far[1], far[2]))
        self.assertIn("out of this mechanism's reach", refusal.message)
        # By velocity it goes as far as there is a pose, and no further.
        while "error" not in (answer := operator.ask("RMAC_CAM.JogJoint", JntNum=0, Velocity=150)) \
                or "coming to rest" in answer["error"]["message"]:  # not renewed in time
            pass
        self.assertIn("no pose", answer["error"]["message"])
        wait_for_rest(operator)
        self.assertGreater(operator.state()["joints"][0], 75)
        self.assertLess(operator.state()["joints"][0], 100)
        rest = operator.state()
        self.assertLess(delta_residual(rest["joints"], rest["pose"][:3]), KINEMATICS_BOUND_MM)

    def test_arm_cuts_its_curves_and_leaves_its_spin_alone(self):
        operator, states = self.cut("SixJointArm", "six-joint-arm", arm_residual)
        spins = [state["joints"][5] for state in states]
        self.assertLess(max(spins) - min(spins), 0.01)
        # Turned by hand it stays where it is put, and the tool where it was.
        tip = operator.state()["pose"][:3]
        operator.call("RMAC_CAM.JogJoint", JntNum=5, Distance=33)
        wait_for_rest(operator)
        self.assertLess(math.dist(operator.state()["pose"][:3], tip), PATH_BOUND_MM)
        operator.call("RMAC_CAM.MoveToPathTarget", MoveID=9, TargetFrame={"p": [tip[0], tip[1] + 20, tip[2]], "axis": operator.state()["pose"][3:]})
        self.assertAlmostEqual(run_to_rest(operator)["joints"][5], spins[-1] + 33, delta=0.01)

    def test_arm_refuses_a_tool_across_its_hand(self):
        operator = self.operator("SixJointArm")
        operator.call("RMAC_CAM.SetToolInterfaceFrame", ToolInterfaceFrame={"p": [5, 0, -80], "q": [1, 0, 0, 0]})
        refusal = operator.refusal("RMAC_CAM.MoveToReferencePoint")
        self.assertIn("cannot lead the tool in use", refusal.message)
        operator.call("RMAC_CAM.SetToolInterfaceFrame", ToolInterfaceFrame={"p": [0, 0, -80], "q": [1, 0, 0, 0]})

    def test_arm_refuses_a_line_that_leads_past_its_waist(self):
        operator = self.operator("SixJointArm")
        operator.call("RMAC_CAM.SetFeedrate", Feedrate=1000)
        x, y, z, *axis = operator.state()["pose"]
        refusal = operator.refusal("RMAC_CAM.MoveToPathTarget", MoveID=1, TargetFrame={"p": [-x, -y, z], "axis": axis})
        self.assertRegex(refusal.message, "reach|singular|beyond its limit")


if __name__ == "__main__":
    unittest.main()
