"""Search and selection of a machine, figures 6.3 to 6.5. As there, the fields wait for Edit, so that nobody changes a search by mistake."""

from PySide import QtGui

from rmac_freecad.jobs import EMPTY, completed
from rmac_freecad.machines import compare
from rmac_freecad.window.dialog import Dialog, OnlyOne, button, row
from rmac_freecad.window.machines.characteristics_dialog import CharacteristicsDialog
from rmac_freecad.window.machines.machine_list import MachineList
from rmac_freecad.window.machines.wanted_fields import ANY, WantedFields
from rmac_freecad.window.quantity import LENGTH, QuantityField, length_text
from rmac_freecad.window.work import work_in_question


class NoneFits(Exception):
    """Its text is for the dialog, whose list tells the rest."""


class SearchDialog(Dialog):
    def __init__(self, session):
        super().__init__(session, "Machine search and selection")
        self.address = QtGui.QLineEdit(session.settings.address)
        self.address.setToolTip("host:port, or unix: and the path of the appliance's socket")
        self.fields = WantedFields()
        self.list = MachineList()
        self.list.itemSelectionChanged.connect(self._enable)
        self.edit_button = button("Edit", self._edit, "Lets the search be changed")
        self.search_button = button("Search machines", self.search)
        self.fits_button = button("Fits this part", self.fits, "Simulates the document's job, or its file of another control, on each machine, with what its axes make of it, and ranks them by time and accuracy")
        self.within = QuantityField(LENGTH, lowest=0)
        self.within.setSpecialValueText(ANY)
        self.within.setToolTip("Machines whose axes keep the tool so near to its path come first, the quickest at the top; then the others, the most accurate first")
        self.characteristics_button = button("Machine characteristics…", self.characteristics)
        self.virtual = QtGui.QCheckBox("Virtual mode")
        self.virtual.setToolTip("The machine is driven as a model, and no drive is touched")
        self.load_button = button("Select", self.load, "Loads the machine's device driver into the controller, at standstill")
        self.characteristics_dialog = None
        box = QtGui.QVBoxLayout(self)
        box.addLayout(row(QtGui.QLabel("Appliance"), self.address, button("Connect", self.connect_and_list)))
        box.addWidget(self.fields)
        box.addLayout(row(self.edit_button, self.search_button, None))
        box.addWidget(self.list)
        box.addLayout(row(self.fits_button, QtGui.QLabel("within"), self.within, self.characteristics_button, None, self.virtual, self.load_button))
        box.addWidget(self.message)
        self.resize(980, 620)
        self._searching(False)
        self._enable()

    def begin(self):
        self.connect_and_list()

    def connect_and_list(self):
        self.session.settings.address = self.address.text()
        self._find("", "connecting…")

    def search(self):
        self._find(self.fields.wanted().condition(), "searching…")

    def fits(self):
        """A job is read here, by FreeCAD's own thread; it is simulated by another one. Rapids are as fast as each machine may go."""
        machines, rmac, within_mm = self.list.machines, self.session.settings.rmac, self.within.quantity or None
        try:
            work = work_in_question()
            readings = {feed: work.reading(feed, rmac) for feed in {machine.max_feed_mm_min for machine in machines}}
        except Exception as error:
            return self.failed(error)

        def compared(client):
            by_feed = {feed: read() for feed, read in readings.items()}
            programs = {machine.name: by_feed[machine.max_feed_mm_min] for machine in machines}
            tools = work.tools(next(iter(by_feed.values())))
            return compare(programs, completed(_table(client), tools), rmac, within_mm)

        self.ask(compared, lambda came: self._show_fits(*came, within_mm), f"{work.label} is simulated on {len(machines)} machines…")

    def characteristics(self):
        self.characteristics_dialog = CharacteristicsDialog(self.session, self.list.chosen)
        self.characteristics_dialog.show()

    def load(self):
        name, virtual = self.list.chosen.name, self.virtual.isChecked()
        self.load_button.setEnabled(False)
        self.change(lambda client: client.load(name, virtual), self._loaded, f"{name} is being loaded; modules that are new are verified first, which takes its time…")

    def failed(self, error):
        super().failed(error)
        self._enable()

    def _find(self, condition, working):
        self.ask(lambda client: client.machines(condition), self._found, working)

    def _found(self, machines):
        self.list.show_machines(machines)
        self._searching(False)
        self._enable()
        self.message.tell(f"{len(machines)} machines" if machines else "No machine is like that; ask for less.")

    def _show_fits(self, fits, why, within_mm):
        self.list.show_fits(fits, why)
        if not fits:
            first, reason = next(iter(why.items()))
            return self.failed(NoneFits(f"None of these machines can cut the job; why not stands beside each. {first}: {reason}"))
        self.message.tell(f"{len(fits)} of {len(self.list.machines)} machines can cut it; {_first(fits[0], within_mm)} A machine is taken to stand at its zero, and the part's zero at the machine's.")

    def _loaded(self, machine):
        self.session.machine = machine
        self._enable()
        self.message.tell(f"{machine.name} is loaded{' in virtual mode' if self.virtual.isChecked() else ''}. Jog sets the part's zero; Machine a job cuts.")

    def _edit(self):
        self._searching(True)

    def _searching(self, on):
        self.fields.setEnabled(on)
        self.search_button.setEnabled(on)
        self.edit_button.setEnabled(not on)

    def _enable(self):
        chosen = self.list.chosen is not None
        self.characteristics_button.setEnabled(chosen)
        self.load_button.setEnabled(chosen)
        self.fits_button.setEnabled(bool(self.list.machines))


def _first(fit, within_mm):
    off_mm = fit.found.off_path_mm
    if within_mm and (off_mm is None or off_mm > within_mm):
        return f"none is known to keep within {length_text(within_mm)} of the path; {fit.machine} is the most accurate."
    return f"{fit.machine} is the quickest{f' within {length_text(within_mm)} of the path' if within_mm else ''}."


def _table(client):
    """The loaded machine's tools; none where no machine is loaded."""
    return client.cam.GetTools() if client.state()["mechanism"] else EMPTY


show = OnlyOne(SearchDialog)
