"""What a file of another control says that is not understood."""


class CodeRefused(Exception):
    """`line` and `column` from 1; None where that is the file as a whole."""

    def __init__(self, why, file="", line=None, column=None):
        where = f"{file}, line {line}, column {column}: " if line else f"{file}: " if file else ""
        super().__init__(where + why)
        self.why = why
        self.line = line
        self.column = column
