#!/usr/bin/env python3
"""Writes src/rmac/generated from what the appliance tells of itself: `generate.py ADDRESS` (--check: only compares).

Its test (tests/system/test_python_client.py) starts an appliance and compares.
"""

import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
FOLDER = HERE / "src/rmac/generated"
sys.path.insert(0, str(HERE / "src"))

HEAD = '"""Written by clients/python/generate.py from rpc.discover; do not edit."""\n\n'
GENERATED = "from __future__ import annotations\n\n"
# Attribute of a client, by the interface on the wire; what has none stands in `connection`.
FACES = {
    "DeviceDriverManager": "drivers", "Device": "device", "RMAC_Config": "config", "RMAC_CAM": "cam",
    "FlightRecorder": "recorder", "Bus": "bus", "authority": "lease", "operator": "post", "": "connection",
}
PLAIN = {"null": "None", "boolean": "bool", "integer": "int", "number": "float", "string": "str", "object": "dict[str, Any]"}
TAKEN = {"Vector": "types.Vector", "Frame": "types.FrameLike", "Nurbs": "types.NurbsLike", "NurbsND": "types.NurbsLike"}
GIVEN = {"Vector": "list[float]", "Frame": "types.WireFrame"}


def constant(name):
    return re.sub(r"\W+", "_", name.split(" ")[0]).upper()


def enumeration(schema):
    half = len(schema["enum"]) // 2
    return [(constant(name), number) for number, name in zip(schema["enum"][:half], schema["enum"][half:])]


def taken(schema):
    """The Python type of a parameter."""
    if "enum" in schema:
        return f"enums.{schema['title']} | int | str"
    if "$ref" in schema:
        return TAKEN[schema["$ref"].rsplit("/", 1)[1]]
    if "oneOf" in schema:
        names = [part.get("$ref", "").rsplit("/", 1)[-1] for part in schema["oneOf"]]
        return "types.FrameLike | types.Joints" if "Joints" in names else "int | str"
    if schema["type"] == "array":
        return {"number": "types.Numbers", "string": "Sequence[str]", "object": "Sequence[Mapping[str, Any]]"}[schema["items"]["type"]]
    return {"object": "Mapping[str, Any]"}.get(schema["type"]) or PLAIN[schema["type"]]


def given(schema):
    """The Python type of a result, and what reads it."""
    if "enum" in schema:
        return f"enums.{schema['title']}", f"enums.{schema['title']}"
    if "$ref" in schema:
        return GIVEN[schema["$ref"].rsplit("/", 1)[1]], ""
    if schema["type"] == "array":
        return f"list[{PLAIN[schema['items']['type']]}]", ""
    return PLAIN[schema["type"]], ""


class Method:
    def __init__(self, described):
        self.wire = described["name"]
        self.interface, _, self.name = self.wire.rpartition(".")
        self.interface = self.interface.removeprefix("rpc")
        self.meaning = described["summary"].replace("\\", "\\\\")
        # What is left out stands last, as Python wants it; parameters travel by name.
        self.params = sorted(described["params"], key=lambda one: not one["required"])
        schema = described["result"]["schema"]
        self.property = "oneOf" in schema
        self.result, self.read = given(schema["oneOf"][0] if self.property else schema)
        self.notes = [self.note(one) for one in described["params"] if "x-unit" in one or "description" in one]
        if "x-unit" in described["result"]:
            self.notes.append(f"Gives {described['result']['x-unit']}.")

    @staticmethod
    def note(one):
        return f"{one['name']}: " + "; ".join(one[key] for key in ("x-unit", "description") if key in one) + "."

    def signature(self, params, first):
        words = list(first)
        for one in params:
            kind = taken(one["schema"])
            words.append(f"{one['name']}: {kind}" if one["required"] else f"{one['name']}: {kind} | None = None")
        return ", ".join(words)

    def forms(self):
        """Parameters and result of each way to call it: a property reads without newVal, and writes with it."""
        if not self.property:
            return [(self.params, self.result)]
        value = dict(next(one for one in self.params if one["name"] == "newVal"), required=True)
        others = [one for one in self.params if one["name"] != "newVal"]
        return [(others, self.result), ([*others, value], "bool")]

    def text(self, first, decorators, head, wrap, body):
        lines = []
        forms = self.forms()
        whole = wrap(self.result) if len(forms) == 1 else "Any"
        for params, result in forms if len(forms) > 1 else []:
            lines += ["    @overload", *decorators, f"    {head} {self.name}({self.signature(params, first)}) -> {wrap(result)}: ..."]
        lines += [*decorators, f"    {head} {self.name}({self.signature(self.params, first)}) -> {whole}:"]
        lines += [f'        """{" ".join([self.meaning, *self.notes])}"""', *body(self)]
        return "\n".join(lines)

    def as_call(self):
        def body(self):
            def made(params, read):
                members = ", ".join(f'"{one["name"]}": {one["name"]}' for one in params)
                return f'return Call("{self.wire}", {{{members}}}{", " + read if read else ""})'

            if self.property:
                (reading, _), (writing, _) = self.forms()
                return ["        if newVal is not None:", f"            {made(writing, '')}", f"        {made(reading, self.read)}"]
            return [f"        {made(self.params, self.read)}"]

        return self.text([], ["    @staticmethod"], "def", lambda result: f"Call[{result}]", body)

    def as_face(self, awaited):
        def body(self):
            names = ", ".join(one["name"] for one in self.params)
            call = f"calls.{class_of(self.interface)}.{self.name}"
            wait = "await " if awaited else ""
            if self.property:
                names = ", ".join(one["name"] for one in self.params if one["name"] != "newVal")
                both = f"{names}, newVal" if names else "newVal"
                return [f"        if newVal is None:", f"            return {wait}self._call({call}({names}))", f"        return {wait}self._call({call}({both}))"]
            return [f"        return {wait}self._call({call}({names}))"]

        return self.text(["self"], [], "async def" if awaited else "def", lambda result: result, body)


def class_of(interface):
    return {"": "Connection", "authority": "Lease", "operator": "Post"}.get(interface, interface)


def by_interface(methods):
    found = {}
    for method in methods:
        found.setdefault(method.interface, []).append(method)
    return found


def faces(methods, kind):
    awaited = kind == "awaiting"
    caller = "AwaitingCaller" if awaited else "BlockingCaller"
    text = HEAD + GENERATED + "from collections.abc import Mapping, Sequence\nfrom typing import Any, overload\n\n"
    text += f"from rmac.generated import calls, enums, types\nfrom rmac.generated.types import {caller}\n"
    interfaces = by_interface(methods)
    for interface, its in interfaces.items():
        text += f"\n\nclass {class_of(interface)}:\n    def __init__(self, call: {caller}) -> None:\n        self._call = call\n"
        text += "".join("\n" + method.as_face(awaited) + "\n" for method in its)
    text += f"\n\nclass Methods:\n    \"\"\"Every method, by the interface that it belongs to.\"\"\"\n\n    def __init__(self, call: {caller}) -> None:\n"
    return text + "".join(f"        self.{FACES[interface]} = {class_of(interface)}(call)\n" for interface in interfaces)


def generate(document):
    """Text by file name."""
    enums = {}
    for described in document["methods"]:
        for one in described["params"]:
            if "enum" in one["schema"]:
                enums[one["schema"]["title"]] = enumeration(one["schema"])
        schema = described["result"]["schema"]
        for part in schema.get("oneOf", [schema]):
            if "enum" in part:
                enums[part["title"]] = enumeration(part)
    methods = [Method(described) for described in document["methods"]]
    calls = HEAD + GENERATED + "from collections.abc import Mapping, Sequence\nfrom typing import Any, overload\n\n"
    calls += "from rmac.generated import enums, types\nfrom rmac.wire.call import Call\n"
    for interface, its in by_interface(methods).items():
        calls += f"\n\nclass {class_of(interface)}:\n" + "\n".join(method.as_call() + "\n" for method in its)
    numbers = HEAD + "from enum import IntEnum\n"
    for name, values in sorted(enums.items()):
        numbers += f"\n\nclass {name}(IntEnum):\n" + "".join(f"    {label} = {number}\n" for label, number in values)
    queueing = sorted(one["name"] for one in document["methods"] if one["x-effect"] == "queues")
    return {
        "queueing.py": HEAD + "QUEUEING = frozenset(\n    {\n" + "".join(f'        "{name}",\n' for name in queueing) + "    }\n)\n",
        "__init__.py": HEAD + f'API_VERSION = "{document["info"]["version"]}"\n',
        "enums.py": numbers,
        "calls.py": calls,
        "blocking.py": faces(methods, "blocking"),
        "awaiting.py": faces(methods, "awaiting"),
    }


def stale(document):
    """Names of files that are not as they would be written now."""
    return [name for name, text in generate(document).items() if not (FOLDER / name).is_file() or (FOLDER / name).read_text() != text]


def discover(address):
    """Asked without the package, parts of which may not be written yet."""
    import json
    import socket

    host, _, port = address.rpartition(":")
    with socket.create_connection((host, int(port))) as connection, connection.makefile("rwb") as lines:
        lines.write(b'{"jsonrpc":"2.0","id":1,"method":"rpc.discover"}\n')
        lines.flush()
        return json.loads(lines.readline())["result"]


def main():
    words = [word for word in sys.argv[1:] if word != "--check"]
    if len(words) != 1:
        sys.exit(__doc__)
    document = discover(words[0])
    if "--check" in sys.argv:
        sys.exit("stale: " + ", ".join(names) if (names := stale(document)) else 0)
    for name, text in generate(document).items():
        (FOLDER / name).write_text(text)


if __name__ == "__main__":
    main()
