"""Small faults for C++ sources: one changed operator, constant, condition, statement or argument each.

It reads tokens, not syntax. The layout that clang-format gives tells a comparison from a template's bracket: binary
operators stand between blanks. What the compiler refuses is not a mutant, so a guess that is wrong costs time only."""

import re
from dataclasses import dataclass

TOKEN = re.compile(
    r"""(?P<comment>//(?:\\\n|[^\n])*|/\*.*?\*/)
      | (?P<directive>^[ \t]*\#(?:\\\n|[^\n])*)
      | (?P<raw>(?:u8|[uUL])?R"(?P<mark>[^(\s]*)\(.*?\)(?P=mark)")
      | (?P<text>(?:u8|[uUL])?(?:"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'))
      | (?P<number>\.?\d(?:[eEpP][+-]|[\w.]|'\w)*)
      | (?P<name>[A-Za-z_]\w*)
      | (?P<sign><=>|<<=|>>=|->\*|\.\.\.|::|->|\+\+|--|<<|<=|>=|==|!=|&&|\|\||[-+*/%&|^]=|[^\s\w])""",
    re.VERBOSE | re.DOTALL | re.MULTILINE)

OPERATORS = {
    "<": ("<=", ">="), "<=": ("<", ">"), ">": (">=", "<="), ">=": (">", "<"), "==": ("!=",), "!=": ("==",),
    "&&": ("||",), "||": ("&&",), "+": ("-",), "-": ("+",), "*": ("/",), "/": ("*",), "%": ("*",), "&": ("|",), "|": ("&",),
    "<<": (">>",), ">>": ("<<",), "+=": ("-=",), "-=": ("+=",), "*=": ("/=",), "/=": ("*=",), "&=": ("|=",), "|=": ("&=",),
}
SIBLINGS = {}  # a name that is taken for its neighbour
for pair in ("true false", "min max", "first second", "front back", "sin cos", "floor ceil", "x y", "rows cols"):
    one, other = pair.split()
    SIBLINGS |= {one: other, other: one}
# Nobody notices another capacity or another text of a log.
NOT_MUTATED = {"static_assert", "reserve", "shrink_to_fit", "spdlog", "assert", "using", "template", "operator", "friend"}
COMMUTATIVE = {"min", "max", "hypot", "swap", "dot"}
KEYWORDS = {"if", "for", "while", "switch", "return", "case", "else", "do", "break", "continue", "throw", "new", "delete",
            "const", "auto", "static", "constexpr", "struct", "class", "enum", "namespace", "default", "goto", "try", "catch",
            "extern", "public", "private", "protected", "inline", "typename", "concept", "requires", "co_return"}


@dataclass(frozen=True)
class Token:
    kind: str
    text: str
    begin: int
    end: int


@dataclass(frozen=True)
class Mutant:
    path: str  # of the source
    begin: int  # what it replaces: characters of the source
    end: int
    text: str
    what: str

    def apply(self, source):
        return source[:self.begin] + self.text + source[self.end:]

    def line(self, source):
        return source.count("\n", 0, self.begin) + 1


def tokens_of(source):
    found = []
    for match in TOKEN.finditer(source):
        kind = match.lastgroup if match.lastgroup != "mark" else "raw"
        if kind not in ("comment", "directive"):
            found.append(Token(kind, match.group(), match.start(), match.end()))
    return found


class Reader:
    """The tokens of a source, with the partner of each bracket and what is left alone."""

    OPEN, CLOSE = "([{", ")]}"

    def __init__(self, source):
        self.source = source
        self.tokens = tokens_of(source)
        self.partner = {}
        self.alone = [False] * len(self.tokens)
        self._pair()
        self._leave_template_arguments()
        self._leave_declarations_and_logs()
        self.blocks = [(begin, end) for begin, end in self.statements() if self.text(end) == "{"]

    def text(self, at):
        return self.tokens[at].text if 0 <= at < len(self.tokens) else ""

    def between(self, first, last):
        """What stands in the source from one token to another, both included."""
        return self.source[self.tokens[first].begin:self.tokens[last].end]

    def spaced(self, at):
        token = self.tokens[at]
        return self.source[token.begin - 1].isspace() and self.source[token.end:token.end + 1].isspace()

    def _pair(self):
        open_now = []
        for at, token in enumerate(self.tokens):
            if token.kind == "sign" and token.text in self.OPEN:
                open_now.append(at)
            elif token.kind == "sign" and token.text in self.CLOSE and open_now:
                begin = open_now.pop()
                self.partner[begin], self.partner[at] = at, begin

    def _leave_template_arguments(self):
        depth = 0
        for at, token in enumerate(self.tokens):
            if token.text == "<" and not self.spaced(at) and self.tokens[at - 1].kind == "name" or token.text == "<" and depth:
                depth += 1
            if depth:
                self.alone[at] = True
            if depth and token.text in (">", ">>"):
                depth -= len(token.text)
            if depth and token.text in (";", "{"):
                depth = 0  # it was no template

    def statements(self):
        """First and last token of what stands between semicolons and braces, the semicolon or brace included."""
        begin, depths = 0, [0]  # of round and square brackets, within each open brace
        for at, token in enumerate(self.tokens):
            if token.text in ("(", "["):
                depths[-1] += 1
            elif token.text in (")", "]"):
                depths[-1] -= 1
            elif token.text in ("{", "}") or token.text == ";" and depths[-1] <= 0:
                yield begin, at
                begin = at + 1
                if token.text == "{":
                    depths.append(0)
                elif token.text == "}" and len(depths) > 1:
                    depths.pop()

    def _leave_declarations_and_logs(self):
        types = []  # braces of classes and enumerations that are open
        for begin, end in self.statements():
            names = {self.text(at) for at in range(begin, end + 1)}
            opens = self.text(end) == "{"
            if names & NOT_MUTATED:
                self._leave(begin, end)
            declares_type = opens and names & {"class", "struct", "enum", "union"} and "(" not in names
            if types and begin <= types[-1] and self._direct_member(types[-1], begin):
                self._leave(begin, end)
            elif declares_type:
                self._leave(begin, end)
            if declares_type and end in self.partner:
                types.append(self.partner[end])
            while types and end >= types[-1]:
                types.pop()

    def _direct_member(self, closing, at):
        """Whether the brace that encloses this token is the one that ends there: not a body of a member."""
        opening, depth = self.partner[closing], 0
        for i in range(opening + 1, at):
            depth += {"{": 1, "}": -1}.get(self.text(i), 0) if self.tokens[i].kind == "sign" else 0
        return depth == 0

    def _leave(self, begin, end):
        for at in range(begin, end + 1):
            self.alone[at] = True

    def arguments(self, opening):
        """First and last tokens of the arguments between these brackets; none where one of them is empty."""
        closing = self.partner.get(opening)
        parts, begin, at = [], opening + 1, opening + 1
        while closing and at <= closing:
            if self.text(at) in (",", ";") or at == closing:
                if begin > at - 1 or self.text(at) == ";":
                    return []
                parts.append((begin, at - 1))
                begin = at + 1
            at = self.partner[at] + 1 if self.text(at) in self.OPEN and at in self.partner and at != closing else at + 1
        return parts

    def returns_truth(self, at):
        """Whether the function around this token is declared to return bool: - of that is the same again."""
        around = [(begin, end) for begin, end in self.blocks if end < at < self.partner.get(end, 0)]
        for begin, end in reversed(around):
            header = [self.text(i) for i in range(begin, end)]
            if set(header) & {"if", "for", "while", "switch", "else", "do", "try", "catch"}:
                continue
            is_lambda = "[" in header
            return header[-1:] == ["bool"] if is_lambda else "bool" in header[:header.index("(")] if "(" in header else False
        return False

    def end_of_expression(self, at):
        """The token before the comma, semicolon, colon or closing bracket that ends what begins here."""
        while at < len(self.tokens):
            if self.text(at) in (",", ";", ":", ")", "]", "}"):
                return at - 1
            at = self.partner[at] + 1 if self.text(at) in self.OPEN and at in self.partner else at + 1
        return at - 1


def changed_number(text):
    match = re.fullmatch(r"(0[xX][\da-fA-F']+|[\d'.]+(?:[eE][-+]?\d+)?)(\w*)", text)
    if not match:
        return []
    digits, suffix = match.groups()
    if re.fullmatch(r"\d+", digits) and suffix not in ("U", "u", "L", "UL", "f", ""):
        return [(f"{int(digits) + 1}{suffix}", "a constant + 1")]
    zero = not re.search(r"[1-9a-fA-F]", digits)
    return [(f"({text} + 1)", "a constant + 1"), (f"({text} - 1)", "a constant - 1")] + (
        [] if zero or suffix.lower() in ("u", "ul") else [(f"(-{text})", "the sign of a constant")])


def mutants_of(path, source):
    """Every mutant of a source, in order."""
    reader = Reader(source)
    found = []

    def add(first, last, text, what):
        begin, end = reader.tokens[first].begin, reader.tokens[last].end
        if source[begin:end] != text:
            found.append(Mutant(path, begin, end, text, what))

    for at, token in enumerate(reader.tokens):
        if reader.alone[at]:
            continue
        before, after = reader.text(at - 1), reader.text(at + 1)
        if token.kind == "number":
            if not (before == "=" and reader.text(at - 2) == ")"):  # a pure virtual function
                for text, what in changed_number(token.text):
                    add(at, at, text, what)
        elif token.kind == "sign":
            if token.text in OPERATORS and reader.spaced(at):
                for text in OPERATORS[token.text]:
                    add(at, at, text, f"{token.text} becomes {text}")
            elif token.text == "!":
                add(at, at, "", "! dropped")
            elif token.text == "-" and before in ("(", ",", "=", "return", "?", ":", "{"):
                add(at, at, "", "a sign dropped")
            elif token.text == "?" and reader.spaced(at):
                last = reader.end_of_expression(at + 1)
                if reader.text(last + 1) == ":":
                    end = reader.end_of_expression(last + 2)
                    if "?" not in {reader.text(i) for i in range(at + 1, end + 1)}:
                        swapped = f"{reader.between(last + 2, end)} : {reader.between(at + 1, last)}"
                        add(at + 1, end, swapped, "branches of ?: swapped")
            elif token.text in ("(", "{") and (reader.tokens[at - 1].kind == "name" or token.text == "{"):
                parts = reader.arguments(at)
                if len(parts) >= 2 and before not in KEYWORDS | COMMUTATIVE:
                    (a, b), (c, d) = parts[:2]
                    add(a, d, f"{reader.between(c, d)}, {reader.between(a, b)}", "arguments swapped")
        elif token.kind == "name":
            if token.text in SIBLINGS and (token.text in ("true", "false") or before in (".", "::", "->") or after == "("):
                add(at, at, SIBLINGS[token.text], f"{token.text} becomes {SIBLINGS[token.text]}")
            elif token.text == "if" and after == "(" and at + 1 in reader.partner:
                last = reader.partner[at + 1] - 1
                first = max([at + 2] + [i + 1 for i in range(at + 2, last) if reader.text(i) == ";"])
                add(first, last, f"!({reader.between(first, last)})", "condition negated")
            elif token.text == "return" and after != ";":
                last = reader.end_of_expression(at + 1)
                if reader.text(last + 1) != ";":
                    continue
                value = reader.between(at + 1, last)
                if value not in ("true", "false", "{}", "nullptr", "std::nullopt"):
                    add(at + 1, last, "{}", "returns nothing")
                    logic = any(reader.text(i) in ("<", "<=", ">", ">=", "==", "!=", "&&", "||", "!")
                                for i in range(at + 1, last + 1))
                    logic = logic or reader.returns_truth(at)
                    add(at + 1, last, f"{'!' if logic else '-'}({value})", "result negated")
    for begin, end in reader.statements():
        if reader.alone[begin] or reader.text(end) != ";" or reader.tokens[begin].kind != "name":
            continue
        what = dropped_statement(reader, begin, end)
        if what:
            add(begin, end, ";", what)
    return sorted(found, key=lambda m: (m.begin, m.end, m.text))


def dropped_statement(reader, begin, end):
    """What kind of statement it is that can be left out: a call or an assignment, or none of them."""
    while reader.text(begin) in ("if", "for", "while", "else"):  # the one statement that it governs
        if reader.text(begin) != "else":
            begin += 1
            if begin not in reader.partner:
                return None
            begin = reader.partner[begin]
        begin += 1
    if begin >= end or reader.text(begin) in KEYWORDS:
        return None
    assigns, at = False, begin
    while at < end:
        token, after = reader.tokens[at], reader.tokens[at + 1]
        if token.text == "=" and after.text in ("default", "delete"):
            return None  # a function
        if not assigns and token.kind == "name" and after.kind == "name" or token.text in (">", "*", "&", "auto") and (
                after.kind == "name" and not assigns):
            return None  # a declaration
        if token.text == "=" or (token.text in OPERATORS and token.text.endswith("=") and token.text[0] in "+-*/&|"):
            assigns = True
        at = reader.partner[at] + 1 if token.text in reader.OPEN and at in reader.partner else at + 1
    if assigns:
        return "an assignment dropped"
    return "a call dropped" if reader.text(end - 1) == ")" else None
