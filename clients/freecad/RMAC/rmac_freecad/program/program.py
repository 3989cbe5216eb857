"""Moves in their order, each with its place in the job."""

import json

from rmac.moves import Arc, Nurbs, item

CURVED = (Arc, Nurbs)


class Program:
    def __init__(self):
        self.moves = []
        self._places = []
        self._numbers = {}  # of moves, by their identity

    def __len__(self):
        return len(self.moves)

    def append(self, given, place):
        move = item(given)
        self._numbers[id(move)] = len(self.moves)
        self.moves.append(move)
        self._places.append(place)

    def ways(self):
        """Of each move: itself where it is curved, else where it ends; None of what does not move."""
        return (move if isinstance(move, CURVED) else None if move.end is None else tuple(move.end) for move in self.moves)

    def place_of(self, index):
        """Of a part of a run (`part.index`) or a refused move (`MoveRefused.index`), from 0; a move's id in the text, and a
        line of it, is one more."""
        return self._places[index]

    def index_of(self, move):
        """None of a move that is none of this program's, as the way back onto its path."""
        return self._numbers.get(id(move))

    def text(self):
        """As a `.rmac` program: one request a line."""
        return "".join(
            json.dumps({"jsonrpc": "2.0", "id": number, **move.request(number)}, separators=(",", ":")) + "\n"
            for number, move in enumerate(self.moves, 1)
        )
