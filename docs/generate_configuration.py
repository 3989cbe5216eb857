#!/usr/bin/env python3
"""Writes configuration.md from the schemas in etc/: run it after changing one of them."""

import json
import pathlib

FOLDER = pathlib.Path(__file__).resolve().parent
ETC = FOLDER.parent / "etc"

INTRODUCTION = """# Configuration

Two files configure the appliance: `rmacd.json` the daemon, `device.json` one mechanism each. Both are checked against the
schemas in `etc/` (`rmacd.schema.json`, `device.schema.json`), which are compiled into the daemon; editors that know JSON
schemas can use them as well. So are the register maps of Modbus devices ([modbus.md](modbus.md)) and the descriptions of CANopen drives ([fieldbus.md](fieldbus.md#a-drive-that-needs-to-be-told-about-ten-minutes)). This page is made from
the schemas by `docs/generate_configuration.py`.

A mistake is never passed over: an unknown key, a key that stands twice, a wrong type, a value out of range. The message
names file, key (as a JSON pointer), value and what is allowed; a syntax error is told by line and column:

    etc/rmacd.json: /listen/port is 70000; allowed is an integer from 0 to 65535
    device.json: /Joints/0 has the unknown key "MaxSped"; did you mean "MaxSpeed"? allowed are ControlMethod, Gains, …
    device.json: line 12, column 7 is not JSON: syntax error while parsing object separator - …

`rmacd --config FILE --check` reads the configuration and the drives folder, says what is wrong with them, and ends.

## Where things are

| | an installed daemon | a daemon in a build tree |
| --- | --- | --- |
| device tree | `lib/<architecture>/rmac/drivers` of the installation | `drivers` of the build tree |
| drives folder | `etc/rmac/drives` of the installation; `/etc/rmac/drives` where the prefix is `/usr` | `etc/drives` of the source |
| work materials | `materials.json` beside the drives folder | `etc/materials.json` of the source |
| state folder | what systemd gives (`$STATE_DIRECTORY`), else `/var/lib/rmac` | `state` of the build tree |
| runtime folder | what systemd gives (`$RUNTIME_DIRECTORY`), else `/run/rmac` | the state folder |

`/var/lib` stands for the state folder of the prefix that was installed to. Whoever sets `state_folder` gets the UNIX socket
there too, unless `unix_socket` is set. The command line goes over the file, and what follows from a value follows it:
the database's place from the state folder, the module folders from the device tree. Relative paths in the file are
relative to the file's folder, those on the command line to the current one.
"""

MECHANISMS = """
Its `Type` (in any case of letters), `ConfigurationType` and `MechanismName` are the names of these three folders. A folder whose file has a mistake is left out of the
device driver database and reported; the others are not affected. A mechanism whose modules are missing is listed, and
loading it says which module is missing.

Beside the ranges below: `Min` is below `Max`; no two joints share a name; there are at least as many `Actuators` as
`Joints` and `HeldJoints`; no two actuators or spindles share a bus axis; no two inputs, and no two outputs, share a bit.

A mechanism keeps its `MechanismID` for good, also when its folder goes away and comes back. A file may claim a number; a
claim on another mechanism's number, or a change of the number that clients know, is reported and the folder left out.
"""


def resolve(schema, entry):
    """The entry with what its reference points to; its own description wins."""
    if "$ref" not in entry:
        return entry
    target = schema
    for step in entry["$ref"].removeprefix("#/").split("/"):
        target = target[step]
    return {**target, **{key: value for key, value in entry.items() if key != "$ref"}}


def number(value):
    return format(value, "g") if abs(value) < 1e6 or value % 1 else format(value, "d")


def allowed(entry):
    if "enum" in entry:
        return ", ".join(f"`{json.dumps(value)}`" for value in entry["enum"])
    kind = entry.get("type", "")
    if isinstance(kind, list):
        return entry["x-form"]
    if kind in ("number", "integer"):
        low = "> " + number(entry["exclusiveMinimum"]) if "exclusiveMinimum" in entry else None
        low = number(entry["minimum"]) if "minimum" in entry else low
        high = number(entry["maximum"]) if "maximum" in entry else None
        return kind + (f", {low} to {high}" if low and high else "")
    if kind == "string":
        form = entry.get("x-form")
        length = f"at most {entry['maxLength']} characters" if "maxLength" in entry else None
        return ", ".join(part for part in ("text", form, length) if part)
    if kind == "array":
        return f"array, {entry.get('minItems', 0)} to {entry['maxItems']} entries"
    if kind == "object" and "maxProperties" in entry:
        return f"object, at most {entry['maxProperties']} keys"
    return {"boolean": "true or false"}.get(kind, kind)


def default(entry, required):
    if required:
        return "required"
    if "x-default" in entry:
        return entry["x-default"]
    return f"`{json.dumps(entry['default'])}`" if "default" in entry else ""


def rows(schema, entry, prefix=""):
    for key, value in entry.get("properties", {}).items():
        value = resolve(schema, value)
        cells = [f"`{prefix}{key}`", value.get("x-unit", ""), allowed(value), default(value, key in entry.get("required", [])),
                 value["description"]]
        yield "| " + " | ".join(cells) + " |"
        yield from rows(schema, value, f"{prefix}{key}.")
        if isinstance(value.get("items"), dict):
            yield from rows(schema, resolve(schema, value["items"]), f"{prefix}{key}[].")


def table(schema):
    return "\n".join(["| key | unit | allowed | default | meaning |", "| --- | --- | --- | --- | --- |", *rows(schema, schema)])


def section(name, text=""):
    schema = json.loads((ETC / f"{name}.schema.json").read_text(encoding="utf-8"))
    return f"\n## {schema['title']}\n\n{schema['description']}\n{text}\n{table(schema)}\n"


if __name__ == "__main__":
    page = INTRODUCTION + section("rmacd") + section("device", MECHANISMS) + section("modbus-spindle") + section("modbus-io") + section("drive") + section("tools") + section("setup") + section("materials") + section("measuring-plan")
    (FOLDER / "configuration.md").write_text(page, encoding="utf-8")
