"""Feeds a program to the machine; what it says comes with its place in the job."""

import rmac


class CutEnded(Exception):
    """Before the program's end. `place` tells where in the job; the package's own exception is the cause, from which
    `client.resume` goes on where the connection was lost."""

    def __init__(self, why, place):
        super().__init__(f"{place}: {why}" if place else why)
        self.place = place
        self.why = why

    @property
    def lost(self):
        """What `cut` goes on from where the connection was lost in mid-cut; else None."""
        return self.__cause__ if isinstance(self.__cause__, rmac.Interrupted) else None


def cut(client, program, lost=None):
    """Gives the place of each move once it is done. The caller holds authority; leaving its block stops the machine. With `lost`, of
    a `CutEnded` of this program, it goes on from where the machine stands, over a connection that is there again."""
    for index in cut_moves(client, program, lost):
        yield program.place_of(index)


def cut_moves(client, program, lost=None):
    """As `cut`, and gives the move's index in the program."""
    done = 0 if lost is None else lost.done
    try:
        for part in client.run(program.moves) if lost is None else client.resume(lost):
            index = part.index if lost is None else program.index_of(part.move)
            if index is not None and index >= done:  # else it only leads back to where it goes on
                done = index + 1
                yield index
    except rmac.MoveRefused as refused:
        index = refused.index if lost is None else done
        raise CutEnded(str(refused.refusal), program.place_of(min(index, len(program) - 1))) from refused
    except (rmac.MachineStopped, rmac.Interrupted) as ended:
        raise CutEnded(str(ended), program.place_of(min(done, len(program) - 1))) from ended
