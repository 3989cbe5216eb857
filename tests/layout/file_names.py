"""Names that a source keeps to itself, and the sources beside it that say them too.

Sources of a folder are compiled some at a time, as one (cmake/together.cmake; a program's main.cpp is not). What a call means must not depend on which files stand
beside it: no name of one source's file scope (in an anonymous namespace, static, a constant, an alias) is said by another source of its
folder, unless that one declares the very same alias itself. Members and qualified names mean what they mean wherever they stand.
"""
import collections
import re

# One of two sources of the same header: a build has one of them.
EITHER = {"gateway/verifier/trap_sanitized.cpp"}
LITERALS = re.compile(r"std::(\w+::)*\w*literals$")
# What only looks like code: literals, comments and directives. A quote behind a digit parts thousands.
NO_CODE = re.compile(r'''R"(?P<mark>[^\s()"]*)\(.*?\)(?P=mark)"|"(?:\\.|[^"\\\n])*"|(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])+'|//[^\n]*|/\*.*?\*/|^[ \t]*#(?:\\\n|[^\n])*''',
                     re.S | re.M)
MEANS_ITSELF = (".", "->", "::", "struct", "class", "enum")


def code(text):
    return NO_CODE.sub(lambda match: '""' if match[0][0] in "\"'R" else " ", text)


def declared(statement, kept):
    """The name and the words of what a statement of a file's scope declares for this file alone, or None."""
    statement = re.sub(r"\[\[.*?\]\]|^template *<.*?> (?=\w)", "", " ".join(statement.split()))
    for alias in (r"(?:using|namespace) (\w+) ?=", r"using namespace ([\w:]+)", r"using (?:\w+::)*(\w+)"):
        if match := re.match(alias, statement):
            return match[1], statement
    if not kept and not re.match(r"(inline )?static\b|(constexpr|const)\b(?!.*\()", statement):
        return None
    if match := re.match(r"(?:struct|class|union|enum class|enum) (\w+)(?: final)?(?: ?:.*)?$", statement):
        return match[1], "type"
    if match := re.match(r"[^=({]*?(?<!::)\b(operator ?[^ (\w]+|\w+) ?\(", statement):
        return match[1], "function"
    if match := re.match(r"[^=({\[]*?\b(\w+) ?(?:=|\{|\[|$)", statement):
        return match[1], "value"
    return None


def file_names(text):
    """The names of a source's file scope, each with its kind, or with the words of its alias."""
    names, inside, statement = {}, [], ""

    def take():
        found = declared(statement, "kept" in inside)
        if found and found[0] != "catch":  # of a function that is one try
            names[found[0]] = found[1]

    for part in re.findall(r"[{};]|[^{};]+", code(text)):
        at_scope = "body" not in inside
        if part == "{":
            space = re.search(r"\bnamespace( [\w:]+)?\s*$", statement) if at_scope else None
            if at_scope and not space:
                take()
            inside.append(("shared" if space[1] else "kept") if space else "body")
            statement = "" if space else statement
        elif part == "}":
            inside = inside[:-1]
            # A value's braces end at its semicolon; what follows a body is a new statement.
            if "body" not in inside:
                statement = statement if re.match(r"\s*(inline |static |constexpr |const )", statement) and "(" not in statement else ""
        elif at_scope and part == ";":
            take()
            statement = ""
        elif at_scope:
            statement += part
    return names


def says(text, name, kind):
    """Whether code says a name by itself; of a function: whether it calls it."""
    for match in re.finditer(rf"(?<![\w~]){re.escape(name)}(?!\w)", text):
        if text[:match.start()].rstrip().endswith(MEANS_ITSELF):
            continue
        if kind != "function" or re.match(r"\s*(<[^;()]*>)?\s*\(", text[match.end():]):
            return True
    return False


def shared_names(sources, root):
    """A complaint for each name that a source of a folder keeps and another says."""
    folders = collections.defaultdict(list)
    for path in sources:
        if path.suffix == ".cpp" and path.name != "main.cpp" and path.relative_to(root).as_posix() not in EITHER:
            folders[path.parent].append(path)
    for paths in folders.values():
        texts = {path: code(path.read_text()) for path in paths}
        names = {path: file_names(path.read_text()) for path in paths}
        for path in paths:
            for name, kind in names[path].items():
                if kind.startswith("using namespace") and not LITERALS.match(name):
                    yield f"{path.relative_to(root)}: {kind}: the sources beside it, which are compiled with it, would see all of these names too; name those that it uses"
                    continue
                others = [other.name for other in paths if other != path and not ("using" in kind or "namespace" in kind) & (names[other].get(name) == kind)
                          and says(texts[other], name, kind)]
                if others:
                    yield f"{path.relative_to(root)}: {name} is this file's own, and {', '.join(others)} says it too: they are compiled as one, so rename it, or write it once"
