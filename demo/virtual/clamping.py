"""What stands on the table of SuginoXYZAC, and the tool in its spindle."""

import json

import dome
import stl

MACHINE = "SuginoXYZAC"
PART_FRAME = (0.0, 0.0, -85.0)  # of the machine frame: a plate of 15 mm lies on the turntable
PLATE = 15.0
CLEARANCE = 0.5

# The stud holds the clamp that pushes the block against the jaw. It is taller than it needs to be.
STUD_PLACE, STUD_RADIUS, STUD_TOP = (0.0, 49.0), 5.0, 53.0

TOOL = 1
BALL_RADIUS, CUTS_UP_TO = 5.0, 18.0
TOOL_LENGTH = 100.0
HOLDER_FROM = 40.0  # above the tip
HOLDER = ((14.0, 18.0, 40.0), (25.0, 25.0, 20.0))  # radius below, above, and height


def up(x, y, z):
    return {"p": [x, y, z], "axis": [0, 0, 1]}


def box(name, x, y, z):
    """Between two numbers along each axis."""
    middle = up(*((a + b) / 2 for a, b in (x, y, z)))
    return {"Name": name, "Shape": {"Box": {"Size": [b - a for a, b in (x, y, z)]}}, "Pose": middle}


def fixtures():
    half = dome.WIDTH / 2
    x, y = STUD_PLACE
    stud = {"Cylinder": {"Radius": STUD_RADIUS, "Height": STUD_TOP}}
    return [
        box("plate", (-75, 75), (-55, 65), (-PLATE, 0)),
        box("jaw", (-25, 25), (-half - 15, -half), (0, 8)),
        box("clamp", (-12, 12), (half, 60), (0, 8)),
        {"Name": "clamp stud", "Shape": stud, "Pose": up(x, y, STUD_TOP / 2)},
    ]


def setup(part_mesh):
    """As in setup.json; `part_mesh` is what its `Mesh` has."""
    size = [dome.LENGTH, dome.WIDTH, dome.STOCK_HEIGHT]
    return {
        "Machine": MACHINE,
        "PartFrame": {"p": list(PART_FRAME), "q": [1, 0, 0, 0]},
        "Stock": {"Shape": {"Box": {"Size": size}}, "Pose": up(0, 0, dome.STOCK_HEIGHT / 2)},
        "Part": {"Shape": {"Mesh": part_mesh}},
        "Fixtures": fixtures(),
        "Material": "Al6082-T6",
        "Clearance": CLEARANCE,
    }


def tool():
    sections = [{"Cone": {"Radius": low, "TopRadius": high, "Height": tall}} for low, high, tall in HOLDER]
    shape = {"DC": 2 * BALL_RADIUS, "RE": BALL_RADIUS, "LCF": CUTS_UP_TO, "OAL": 75, "ZEFP": 2, "FHA": 30, "BMC": "HM", "Holder": sections}
    return {"ToolNumber": TOOL, "Name": "ball 10", "Length": TOOL_LENGTH, "Radius": BALL_RADIUS, "Shape": shape}


def write_tools(folder):
    """The machine's tool table, as in the state folder, with the tool in the spindle."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{MACHINE}.json").write_text(json.dumps({"Mounted": TOOL, "Tools": [tool()]}, indent=1))


def write_setup(folder, mesh):
    """setup.json and the mesh of the part beside it; returns the set-up as the daemon takes it, which reads no file."""
    points, triangles = mesh
    stl.write(folder / "part.stl", points, triangles)
    file = folder / "setup.json"
    file.write_text(json.dumps(setup({"File": "part.stl"}), indent=1))
    return file, setup({"Points": points.tolist(), "Triangles": triangles.tolist()})
