"""A part being measured, by a thread of its own; whoever watches asks how far it is."""

from rmac_freecad.measuring.measuring import measure


class Measuring:
    """One at a time. `done` counts places, of `total`."""

    def __init__(self, station, connect):
        """`connect()` gives the client, connected."""
        self._station = station
        self._connect = connect
        self.done = self.total = 0
        self.running = False

    def start(self, plan, check, ended, failed):
        """`check(client)` looks at the machine before anything moves, and gives what `ended(touched, looked)` is told with; by the station's
        `deliver`, as `failed(error)`. A stop that is asked for meanwhile lets nothing begin."""
        self.running, self.done, self.total = True, 0, len(plan.places)
        stops = self._station.stops

        def measured():
            client = self._connect()
            looked = check(client)
            return (None if self._station.stops != stops else measure(client, plan.places, told=self._tell, **plan.ways)), looked

        def over(came):
            self.running = False
            ended(*came)

        def broken(error):
            self.running = False
            failed(error)

        self._station.ask(measured, over, broken)

    def _tell(self, done):
        self.done = done
