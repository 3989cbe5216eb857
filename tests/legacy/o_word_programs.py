"""Programs of O words, made at random from a seed, for compare_rs274.py: subs and numbered programs before and behind their calls,
loops, conditions, values that are given and given back, names of all scopes, computed labels; and some with a fault that both refuse.

What is not made is what LinuxCNC does otherwise than its manual has it, and rmac-import as the manual has it (docs/legacy.md, "Against
LinuxCNC").
"""
import dataclasses
import random
from collections.abc import Callable


@dataclasses.dataclass
class Scope:
    """Where a line is made: what it may name, and what it may leave."""
    values: list[str]
    sub: str = ""  # that may be returned from
    loops: list[str] = dataclasses.field(default_factory=list)  # that may be left, the innermost last
    deep: int = 0
    repeats: bool = True  # may stand here
    callable: list[str] = dataclasses.field(default_factory=list)
    numbered: list[str] = dataclasses.field(default_factory=list)

    def within(self, **changes: object) -> "Scope":
        return dataclasses.replace(self, **{"values": list(self.values), "deep": self.deep + 1, **changes})  # type: ignore[arg-type]


class OWordProgram:
    def __init__(self, seed: int) -> None:
        self.random = random.Random(f"o words {seed}")
        self.lines: list[str] = []
        self.labels = 0
        # Which loops are left early, so that LinuxCNC's memory of it is not met.
        self.style = self.random.choice(["while", "do break", "do continue"])
        front = [self.name() for _ in range(self.random.randint(0, 3))]
        behind = [self.name() for _ in range(self.random.randint(0, 2))]
        numbered = [str(self.label()) for _ in range(self.random.randint(0, 2))]
        self.write("g21 g90 g17 g40 g80 g94 g54")
        self.write("F600 G0 X1 Y2 Z30")
        self.write("#31=3 #32=-2.5 #<main>=4 #<_all>=1.5")
        everywhere = ["#31", "#32", "#<_all>"]
        for i, sub in enumerate(front):
            self.sub(sub, Scope(list(everywhere), callable=front[:i] + behind))
        main = Scope(everywhere + ["#<main>"], callable=front + behind, numbered=numbered)
        self.body(main, self.random.randint(4, 8))
        if self.random.random() < 0.1:
            self.fault(front)
        self.write("M2")
        for i, sub in enumerate(behind):
            self.sub(sub, Scope(list(everywhere), callable=front + behind[i + 1:]))
        for i, program in enumerate(numbered):
            self.write(f"O{program}")
            self.body(Scope(list(everywhere), deep=1, callable=front, numbered=numbered[i + 1:]), 3)
            self.write("M99")

    def write(self, text: str) -> None:
        number = "N%d " % (len(self.lines) * 10) if self.random.random() < 0.1 else ""
        self.lines.append(number + text)

    def label(self) -> int:
        self.labels += 1
        return 100 + self.labels

    def name(self) -> str:
        """As it stands behind an O."""
        label = self.label()
        return self.random.choice([str(label), f"<part {label}>", f"<Part_{label}>"])

    def value(self, scope: Scope) -> str:
        kind = self.random.randint(0, 4)
        if kind == 0 or not scope.values:
            return "%.2f" % self.random.uniform(-9, 9)
        one = self.random.choice(scope.values)
        if kind == 1:
            return one
        other = self.random.choice([*scope.values, "%.1f" % self.random.uniform(-5, 5)])
        # Within bounds, however often it is carried out.
        return "[[%s %s %s] MOD %d]" % (one, self.random.choice(["+", "-", "*"]), other, self.random.randint(5, 40))

    def condition(self, scope: Scope) -> str:
        return "[%s %s %s]" % (self.value(scope), self.random.choice(["LT", "GT", "LE", "GE"]), self.value(scope))

    def body(self, scope: Scope, count: int) -> None:
        kinds: list[Callable[[Scope], None]] = [self.move, self.move, self.arc, self.assign, self.condition_block]
        if scope.deep < 3:
            kinds += [self.loop, self.loop]
        if scope.callable:
            kinds += [self.call]
        if scope.numbered:
            kinds += [self.call_numbered]
        for _ in range(count):
            self.random.choice(kinds)(scope)
        if scope.loops and self.random.random() < 0.6:
            self.leave(scope)
        elif scope.sub and self.random.random() < 0.2:
            self.write(f"o{scope.sub} return" + (f" [{self.value(scope)}]" if self.random.random() < 0.5 else ""))

    def move(self, scope: Scope) -> None:
        words = [axis + self.value(scope) for axis in self.random.sample("XYZ", self.random.randint(1, 3))]
        self.write(self.random.choice(["G0 ", "G1 "]) + " ".join(words))

    def arc(self, scope: Scope) -> None:
        self.write(f"G1 X{self.value(scope)} Y{self.value(scope)}")
        self.write(self.random.choice(["G91 G2 X6 Y2 I3 J1", "G91 G3 X0 Y8 J4", "G91 G3 X5 Y5 R7", "G91 G2 X4 Y0 I2 Z-1"]))
        self.write("G90")

    def assign(self, scope: Scope) -> None:
        name = self.random.choice(["#%d" % self.random.randint(1, 30), "#31", "#<a>", "#<B c>", "#<_all>", "#<_glob>"])
        self.write(f"{name}={self.value(scope)}")
        if name not in scope.values:
            scope.values.append(name)

    def condition_block(self, scope: Scope) -> None:
        label = self.label()
        self.write(f"o{label} if {self.condition(scope)}")
        self.body(scope.within(), self.random.randint(1, 2))
        for _ in range(self.random.choice([0, 0, 1, 2])):
            self.write(f"o{label} elseif {self.condition(scope)}")
            self.body(scope.within(), 1)
        if self.random.random() < 0.5:
            self.write(f"o{label} else")
            self.body(scope.within(), 1)
        self.write(f"o{label} endif")

    def loop(self, scope: Scope) -> None:
        kinds = [self.while_loop]
        if self.style != "while":
            kinds.append(self.do_loop)
        if self.style != "do continue" and scope.repeats:
            kinds.append(self.repeat)
        self.random.choice(kinds)(scope)

    def repeat(self, scope: Scope) -> None:
        label = self.random.choice([str(self.label()), f"[{self.label()} * 1]", f"<round {self.label()}>"])
        self.write(f"o{label} repeat [{self.random.choice(['0', '1', '2', '3', '1.5', '2.5', '2.6', '-1', '0.4'])}]")
        self.body(scope.within(loops=[], sub=""), self.random.randint(1, 3))  # LinuxCNC keeps the count where one leaves it
        self.write(f"o{label} endrepeat")

    def while_loop(self, scope: Scope) -> None:
        label = self.label()
        self.write(f"#<c{label}>=0")
        self.write(f"o{label} while [#<c{label}> LT {self.random.randint(0, 3)}]")
        self.write(f"#<c{label}>=[#<c{label}> + 1]")
        self.body(scope.within(loops=[*scope.loops, str(label)] if self.style == "while" else []), self.random.randint(1, 3))
        self.write(f"o{label} endwhile")

    def do_loop(self, scope: Scope) -> None:
        label = self.label()
        self.write(f"#<c{label}>=0")
        self.write(f"o{label} do")
        self.write(f"#<c{label}>=[#<c{label}> + 1]")
        self.body(scope.within(loops=[*scope.loops, str(label)]), self.random.randint(1, 3))
        self.write(f"o{label} while [#<c{label}> LT {self.random.randint(0, 3)}]")

    def leave(self, scope: Scope) -> None:
        word = {"while": self.random.choice(["break", "continue"]), "do break": "break", "do continue": "continue"}[self.style]
        label = self.label()
        self.write(f"o{label} if {self.condition(scope)}")
        self.write(f"o{self.random.choice(scope.loops)} {word}")
        self.write(f"o{label} endif")
        self.move(scope)

    def arguments(self, scope: Scope) -> str:
        return "".join(f" [{self.value(scope)}]" for _ in range(self.random.randint(0, 4)))

    def call(self, scope: Scope) -> None:
        sub = self.random.choice(scope.callable)
        if sub.isdigit() and self.random.random() < 0.4:
            self.write(f"#33={int(sub) - 7}")
            sub = "[#33 + 7]"
        self.write(f"o{sub} call" + self.arguments(scope))
        self.write("G1 X[#<_value>] Y[#<_value_returned>]")

    def call_numbered(self, scope: Scope) -> None:
        self.write(f"M98 P{self.random.choice(scope.numbered)}" + self.random.choice(["", "", " L1", " L3"]))

    def sub(self, name: str, scope: Scope) -> None:
        """One in three calls itself, until its first value is 0."""
        recursive = self.random.random() < 0.3
        self.write(f"o{name} sub")
        scope = scope.within(values=[*scope.values, *(f"#{i}" for i in range(1, 31))], sub=name, repeats=not recursive)
        scope.deep = 2
        self.move(scope)
        if recursive:
            label = self.label()
            self.write("#1=[FIX[ABS[#1]] MOD 5]")
            self.write(f"o{label} if [#1 GT 0]")
            self.write(f"o{name} call [#1 - 1] [#3]")
            self.move(scope)
            self.write(f"o{label} endif")
            scope.callable = []
        self.body(scope, self.random.randint(1, 3))
        self.write(f"o{name} endsub" + self.random.choice(["", " [5]", " [#2 + 1]"]))

    def fault(self, subs: list[str]) -> None:
        faults = ["o9999 call", "o9999 endif", "o9999 break", "o9999 endwhile", "o9999 if 1", "M98", "M98 P9999", "o9999 what", "M98 P1 L-1",
                  "o9998 repeat [2]\no9998 break\no9998 endrepeat", "o9998 if [1] x1", "o9999 call [1] 2",
                  "o9999 if [1/0]\no9999 endif", "o9999 repeat [2]\no9999 endwhile"]
        faults += [f"o{sub} sub\no{sub} endsub" for sub in subs] + [f"M98 P{sub}" for sub in subs if sub.isdigit()]
        self.lines += self.random.choice(faults).split("\n")
