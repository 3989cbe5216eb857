#!/usr/bin/env python3
"""Holds the tree against docs/architecture.md, and prints what breaks a rule; exit 1 when something does.

  rooms    at most 25 source files a folder, and one CMake target
  arrows   a file includes only of its own room and of the rooms that its CMakeLists.txt names; no circle of folders
  layers   motion knows nobody; fieldbus and drivers know motion (drivers the SDK too), clients nobody; nobody includes a program's folder
  names    a source's own are said by no other source of its folder (file_names.py)
  classes  at most 30 methods and 20 fields, in headers and sources alike; defined in at most 3 sources

--table prints the figures of docs/architecture.md instead.
"""
import argparse
import collections
import pathlib
import re
import sys

import file_names

ROOT = pathlib.Path(__file__).resolve().parents[2]
MOST_FILES, MOST_METHODS, MOST_FIELDS, MOST_SOURCES = 25, 30, 20, 3
AREAS = ("motion", "fieldbus", "drivers", "gateway", "clients")
# Where a folder is a room, and names in its CMakeLists.txt those that it includes.
ROOMED = ("gateway", "clients")
# Whose files may include whose, of what is no room of the gateway.
LAYERS = {"motion": {"motion"}, "fieldbus": {"fieldbus", "motion"}, "drivers": {"drivers", "motion"}, "clients": {"clients"}}
PUBLIC = {"rmac/motion/": "motion", "rmac/fieldbus/": "fieldbus", "rmac/sdk/": "drivers", "rmac/modules/": "drivers"}
LIBRARY_OF = {"motion": "rmac_motion", "fieldbus": "rmac_fieldbus", "drivers": "rmac_sdk"}
# What simulates the other side of a protocol shares no code with this side's.
STRANGERS = {"gateway/simulators": ("rmac/fieldbus/canopen/", "rmac/fieldbus/modbus/")}


# gateway/threads/thread_safety.hpp: said of a class, a method or a field, and neither.
LOCK_WORDS = re.compile(r'\bSCOPED_CAPABILITY\b|\b(?:CAPABILITY|GUARDED_BY|REQUIRES|EXCLUDES|ACQUIRE|RELEASE)\([^()]*\)')


def sources():
    return sorted(p for area in AREAS for p in (ROOT / area).rglob("*.?pp") if p.suffix in (".cpp", ".hpp"))


def includes(path):
    return re.findall(r'^#include "([^"]+)"', path.read_text(), re.M)


def resolve(path, name):
    """The file of ours that an include means, or None."""
    for candidate in (ROOT / name, path.parent / name, ROOT / "motion/src" / name, ROOT / "fieldbus/src" / name,
                      ROOT / "motion/include" / name, ROOT / "fieldbus/include" / name, ROOT / "drivers/sdk/include" / name,
                      ROOT / "drivers/modules/include" / name):
        if candidate.is_file():
            return candidate.resolve()
    return None


def folder(path):
    return path.parent.relative_to(ROOT).as_posix()


def target_text(path):
    """What the CMakeLists.txt that builds a file says."""
    here = path.parent
    while here != ROOT and not (here / "CMakeLists.txt").is_file():
        here = here.parent
    file = here / "CMakeLists.txt"
    return here, file.read_text() if file.is_file() else ""


def targets_of(text):
    return set(re.findall(r"\b(?:add_library|add_executable)\((\S+)", text)) | {"rmac_" + n for n in re.findall(r"\brmac_room\((\S+)", text)}


def check_folders(files, complaints):
    for name, count in sorted(collections.Counter(map(folder, files)).items()):
        if count > MOST_FILES:
            complaints.append(f"{name}: {count} source files; {MOST_FILES} is the most, give parts of it rooms of their own")


def circle_room(path):
    """A folder; the public headers of an area are one, its ports among them."""
    return re.sub(r"^(.*?/include)/.*", r"\1", folder(path))


def arrows(files):
    edges = collections.defaultdict(dict)
    for path in files:
        for name in includes(path):
            other = resolve(path, name)
            if other and circle_room(other) != circle_room(path):
                edges[circle_room(path)].setdefault(circle_room(other), f"{path.relative_to(ROOT)} includes {name}")
    return edges


def check_circles(edges, complaints):
    done, way = set(), []

    def visit(node):
        if node in way:
            circle = way[way.index(node):] + [node]
            complaints.append("folders include each other in a circle: " + " -> ".join(circle) + "\n    " +
                              "\n    ".join(edges[a][b] for a, b in zip(circle, circle[1:])))
            return
        if node in done:
            return
        way.append(node)
        for other in sorted(edges.get(node, ())):
            visit(other)
        way.pop()
        done.add(node)

    for node in sorted(edges):
        visit(node)


def check_arrows(files, complaints):
    for path in files:
        area, here = path.relative_to(ROOT).parts[0], folder(path)
        room, text = target_text(path)
        for name in includes(path):
            for prefix, strangers in STRANGERS.items():
                if here.startswith(prefix) and name.startswith(strangers) and not allowed_stranger(name):
                    complaints.append(f"{path.relative_to(ROOT)} includes {name}: a simulator shares no protocol code with what it is to try")
            other = resolve(path, name)
            if not other:
                continue
            to = other.relative_to(ROOT).parts[0]
            if area in LAYERS and to not in LAYERS[area]:
                complaints.append(f"{path.relative_to(ROOT)} includes {name}: {area} must not know {to}")
                continue
            if area not in ROOMED:
                continue
            if to == area:
                other_room, other_text = target_text(other)
                if other_room == room:
                    continue
                wanted = targets_of(other_text)
                if re.search(r"\badd_executable\(", other_text) and not re.search(r"\b(add_library|rmac_room)\(", other_text):
                    complaints.append(f"{path.relative_to(ROOT)} includes {name}, which belongs to a program")
            else:
                wanted = {LIBRARY_OF.get(to, "(nothing of clients)"), "rmac_driver_parts"}
            if not any(re.search(rf"(?<![\w-]){re.escape(target)}(?![\w-])", text) for target in wanted) and not inherited(text, wanted):
                complaints.append(f"{path.relative_to(ROOT)} includes {name}; {room.relative_to(ROOT)}/CMakeLists.txt names none of {', '.join(sorted(wanted))}")


def allowed_stranger(name):
    # The map of registers is data that both sides read.
    return name in ("rmac/fieldbus/modbus/register_map.hpp",)


def inherited(text, wanted):
    """motion and the SDK come with every room that uses rooms."""
    return bool(wanted & {"rmac_motion", "rmac_sdk"}) and "rmac_" in text


# What only looks like code: literals and comments, whichever begins first. A quote behind a digit parts thousands.
NO_CODE = re.compile(r'''R"(?P<mark>[^\s()"]*)\(.*?\)(?P=mark)"|"(?:\\.|[^"\\])*"|(?<![0-9a-fA-F])'(?:\\.|[^'\\])+'|//[^\n]*|/\*.*?\*/''', re.S)


def bodies(text):
    """Name and body of each class or struct of a file; nested ones apart, and taken out of what holds them."""
    text = NO_CODE.sub(lambda match: "" if match[0].startswith("/") else '""', text)
    text = LOCK_WORDS.sub('', text)
    found = []

    def scan(source, outer):
        rest, at = "", 0
        for match in iter(lambda: re.compile(r'\b(?<!enum )(?:class|struct)\s+(\w+(?:::\w+)*)[^;{}()]*\{').search(source, at), None):
            depth, end = 1, match.end()
            while depth and end < len(source):
                depth += {"{": 1, "}": -1}.get(source[end], 0)
                end += 1
            name = f"{outer}::{match.group(1)}" if outer else match.group(1)
            inner = scan(source[match.end():end - 1], name)
            found.append((name, inner))
            rest += source[at:match.start()] + " nested "
            at = end
        return rest + source[at:]

    scan(text, "")
    return found


def members(body):
    """Methods and fields of a class body, by its declarations."""
    flat, depth = "", 0
    for char in re.sub(r'^\s*#.*$', '', body, flags=re.M):
        if char == "{":
            depth += 1
            flat += "{" if depth == 1 else ""
        elif char == "}":
            depth -= 1
            flat += "}" if depth == 0 else ""
        elif depth == 0:
            flat += char
    flat = re.sub(r'\b(public|private|protected)\s*:', ';', flat)
    flat = re.sub(r'(\)\s*(?:const|noexcept|override|final|\s)*(?::[^;{}]*)?)\{\}', r'\1;', flat)
    methods = fields = 0
    for statement in flat.split(";"):
        statement = " ".join(statement.split())
        if not statement or re.match(r'(using|friend|typedef|enum|static_assert|nested$|static constexpr|static inline constexpr|class \w+$|struct \w+$)', statement):
            continue
        head = re.split(r'[={]', statement)[0]
        head = re.sub(r'<[^<>]*(<[^<>]*(<[^<>]*>[^<>]*)*>[^<>]*)*>', '', head)
        if re.search(r'= (delete|default)$', statement):
            continue
        if "(" in head or "operator" in head:
            methods += 1
        elif re.search(r'\w', head):
            fields += len(re.sub(r'\{[^}]*\}', '', statement).split(",")) if "(" not in statement else 1
    return methods, fields


def classes(files):
    for path in files:
        for name, body in bodies(path.read_text()):
            methods, fields = members(body)
            yield path, name, methods, fields


def definitions(files):
    """Sources in which each class has members defined."""
    where = collections.defaultdict(set)
    for path in files:
        if path.suffix == ".cpp":
            for name in set(re.findall(r'^[\w:<>&*,\s\[\]]*?\b((?:[A-Z]\w+::)+)~?\w+\([^;]*$', path.read_text(), re.M)):
                where[folder(path).split("/")[0], name[:-2]].add(path)
    return where


def check_classes(files, complaints):
    for path, name, methods, fields in classes(files):
        abstract = methods and len(re.findall(r"\bvirtual\b[^;]*= 0", dict(bodies(path.read_text()))[name])) >= methods - 1
        if methods > MOST_METHODS and not abstract:
            complaints.append(f"{path.relative_to(ROOT)}: {name} has {methods} methods; {MOST_METHODS} is the most")
        if fields > MOST_FIELDS and methods > 3:
            complaints.append(f"{path.relative_to(ROOT)}: {name} has {fields} fields; {MOST_FIELDS} is the most")
    for (_, name), paths in sorted(definitions(files).items()):
        if len(paths) > MOST_SOURCES:
            complaints.append(f"{name} is cut into {len(paths)} sources: {', '.join(sorted(p.name for p in paths))}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--table", action="store_true", help="the largest folders and classes")
    options = parser.parse_args()
    files = sources()
    if options.table:
        for name, count in collections.Counter(map(folder, files)).most_common(8):
            print(f"{count:4} files    {name}")
        for path, name, methods, fields in sorted(classes(files), key=lambda c: -c[2])[:12]:
            print(f"{methods:4} methods {fields:3} fields  {name} ({path.relative_to(ROOT)})")
        return 0
    complaints = []
    check_folders(files, complaints)
    check_circles(arrows(files), complaints)
    check_arrows(files, complaints)
    check_classes(files, complaints)
    complaints += file_names.shared_names(files, ROOT)
    for complaint in complaints:
        print(complaint)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
