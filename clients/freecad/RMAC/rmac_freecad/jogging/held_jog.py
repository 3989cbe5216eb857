"""A jog that lasts for as long as a button is held, and not a fifth of a second longer."""

import threading

_END = object()


class HeldJog:
    """A jog by velocity ends 200 ms after it was renewed last. Each renewal comes from the window, by `hold`: where the
    window hangs, or dies, nothing is renewed and the machine stops. One call is under way at a time."""

    def __init__(self, begin, failed):
        """`begin()` gives, for one hold, what makes a call and waits for its answer; `failed(error)` is told once a hold. Both
        are called by this jog's own thread."""
        self._begin = begin
        self._failed = failed
        self._changed = threading.Condition()
        self._next = None
        self._axis = None  # of the button that is held
        self._make = None  # how this hold's calls are made
        self._number = 0  # of this hold
        self._over = True  # refused, or its connection lost: nothing more of this hold is sent
        self._barred = False  # it was stopped, and the button is still down
        self._thread = threading.Thread(target=self._run, name="rmac jog", daemon=True)
        self._thread.start()

    @property
    def held(self):
        return self._axis is not None

    def hold(self, axis, velocity, moving):
        """At every tick of the window's timer while the button is down. `moving`: the machine moves just now; a hold begins
        only when it rests."""
        with self._changed:
            if self._axis is None:
                if moving or self._barred:
                    return
                self._axis, self._over, self._make = axis, False, None
                self._number += 1
            if axis is self._axis and not self._over:
                self._next = axis.at(velocity)
                self._changed.notify()

    def release(self):
        """The button is up. A renewal that was not sent yet is not sent any more."""
        with self._changed:
            self._barred = False
            self._let_go()

    def stop(self):
        """For another reason than that, and the button may be down: it has to come up before it moves anything again."""
        with self._changed:
            self._barred = True
            self._let_go()

    def _let_go(self):
        if self._axis is not None:
            self._next = None if self._make is None else self._axis.at(0)
            self._axis = None
            self._changed.notify()

    def end(self):
        """Nothing more is sent. Waits for the call that is under way."""
        with self._changed:
            self._axis, self._next = None, _END
            self._changed.notify()
        self._thread.join()

    def _run(self):
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._next is not None)
                asked, self._next = self._next, None
                make, number = self._make, self._number
            if asked is _END:
                return
            try:
                if make is None:
                    make = self._begin()
                    with self._changed:
                        if self._axis is None or number != self._number:
                            continue  # let go before it began
                        self._make = make
                make(asked)
            except Exception as error:  # the user is told, and the machine stops, for nothing renews it
                with self._changed:
                    told, self._over = self._over, True
                if not told:
                    self._failed(error)
