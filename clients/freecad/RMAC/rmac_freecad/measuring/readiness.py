"""What must be right before a probe moves, told before it does."""

from rmac_freecad.running import NotReady

SAME_MM = 0.02  # a tip that is given and the one of the table
STANDS_RPM = 1.0


def check_probe(client, now, tip_radius_mm, is_built_in):
    """`now` as `running.look` gives it; `is_built_in`: the user says that the probe is the machine's, and no tool of its table. `NotReady` says what to do."""
    state, name, number = client.state(), now.machine.name, now.tools["Mounted"]
    if state["virtual"]:
        raise NotReady(f"{name} is loaded in virtual mode, in which nothing is touched. Select it without virtual mode.")
    if not client.cam.ProbeActive():
        raise NotReady(f"{name} has no probe that answers: it lacks an input named Probe, or the probe has no power.")
    if any(abs(rpm) > STANDS_RPM for rpm in state["spindle_rpm"]):
        raise NotReady("The spindle turns. Stop it, and put the probe in.")
    if number is None:
        raise NotReady("Nobody knows which tool is in the spindle, so nobody knows that it is the probe: look, and say it (rmac confirm NUMBER).")
    if number == 0:
        if not is_built_in:
            raise NotReady("No probe is in the spindle, as far as the machine knows. Enter the probe into the tool table, with its length and its tip's radius, and change to it; or tick that the probe is built in.")
        return
    tool = next((one for one in now.tools["Tools"] if one["ToolNumber"] == number), {})
    called = f"tool {number}{f' ({label})' if (label := tool.get('Name')) else ''}"
    if tool.get("NeedsSpindle", True):
        raise NotReady(f"No probe is in the spindle, but {called}, which cuts. Change to the probe; in the tool table it is a tool that needs no spindle (NeedsSpindle false).")
    if abs(tool["Radius"] - tip_radius_mm) > SAME_MM:
        raise NotReady(f"The tool table gives {called} a tip with a radius of {tool['Radius']:g} mm, and here it is {tip_radius_mm:g} mm. Give what is right; rmac qualify finds it.")
