"""The object of a document that has a file of another control, its options, and the program that was made of it last."""

from rmac_freecad.legacy.importing import import_source
from rmac_freecad.legacy.options import LANGUAGES, UNITS, Options
from rmac_freecad.legacy.source import Source, check_unchanged, read_source

GROUP = "Legacy code"
HIDDEN, READ_ONLY = 2, 1  # FreeCAD's editor modes
# Name, type, value before anybody gives one, and what it is.
PROPERTIES = (
    ("File", "App::PropertyString", "", "Where the file was when it was opened. While it is there, a change of it is told; empty, nobody looks"),
    ("FileName", "App::PropertyString", "", "Its name"),
    ("SHA256", "App::PropertyString", "", "Of its content"),
    ("Source", "App::PropertyString", "", "The file as it was opened, packed"),
    ("Language", "App::PropertyEnumeration", list(LANGUAGES), "--dialect"),
    ("Unit", "App::PropertyEnumeration", list(UNITS), "--unit: of a program that does not say its own"),
    ("Rapid", "App::PropertyFloat", Options.rapid_mm_min, "--rapid: mm/min; at most what the machine may go"),
    ("Approach", "App::PropertyString", "", "--approach: X,Y,Z in mm where the tool goes first"),
    ("AssumeG43", "App::PropertyBool", False, "--assume-g43: the tool's length counts from M6 on"),
    ("BlockDelete", "App::PropertyBool", False, "--block-delete: leave out blocks that begin with /"),
    ("Further", "App::PropertyString", "", "Further options of rmac import"),
)  # fmt: skip


class Code:
    """Of FreeCAD's objects. `last` is what was read last, with what it was read from; it is saved with no document."""

    def __init__(self, feature):
        self.last = None
        feature.Proxy = self

    def execute(self, feature):
        """Nothing is computed here: it would hold up the window."""

    def __getstate__(self):
        return None

    def __setstate__(self, state):
        self.last = None


def codes(document):
    return [] if document is None else [one for one in document.Objects if is_code(one)]


def is_code(feature):
    return isinstance(getattr(feature, "Proxy", None), Code)


def open_code(document, path, options=Options(), rmac="rmac"):
    """Reads the file, imports it, and puts it into the document; refused, it leaves the document as it is. One that was opened from the
    same path before is replaced."""
    source = read_source(path)
    return code_of(document, source, options, import_source(source, options, rmac=rmac))


def code_of(document, source, options, program):
    """Of what was read and imported already; in one step that can be undone."""
    document.openTransaction(f"Open {source.name}")
    feature = next((one for one in codes(document) if one.File == source.path), None)
    if feature is None:
        feature = document.addObject("App::FeaturePython", "LegacyCode")
        Code(feature)
        _add_properties(feature)
        feature.Label = source.name
    _fill(feature, source, options)
    feature.Proxy.last = _key(source, options), program
    feature.purgeTouched()
    document.commitTransaction()
    return feature


def options_of(feature):
    return Options(LANGUAGES[feature.Language], UNITS[feature.Unit], feature.Rapid, feature.Approach, feature.AssumeG43, feature.BlockDelete, feature.Further)


def reading(feature, fastest_mm_min=float("inf"), rmac="rmac", unchanged=True):
    """What a thread may call, for as long as it takes: it gives the program. The object is looked at now. `unchanged`: refused where the
    file was changed since."""
    proxy, path, packed, options = feature.Proxy, feature.File, feature.Source, options_of(feature)
    name = feature.FileName

    def read():
        source = Source.unpacked(path or name, packed)
        if unchanged and path:
            check_unchanged(source)
        key = _key(source, options, fastest_mm_min)
        last = proxy.last
        if last is not None and last[0] == key:
            return last[1]
        program = import_source(source, options, fastest_mm_min, rmac)
        proxy.last = key, program
        return program

    return read


def read_code(feature, *, rapid_mm_min, rmac="rmac"):
    """As `jobs.read_job` does of a job. Waits."""
    return reading(feature, rapid_mm_min, rmac)()


def _key(source, options, fastest_mm_min=float("inf")):
    return source.sha256, source.name, options, min(fastest_mm_min, options.rapid_mm_min)


def _add_properties(feature):
    for name, kind, value, what in PROPERTIES:
        feature.addProperty(kind, name, GROUP, what)
        setattr(feature, name, value)
    feature.setEditorMode("Source", HIDDEN)
    for name in ("FileName", "SHA256"):
        feature.setEditorMode(name, READ_ONLY)


def _fill(feature, source, options):
    feature.File, feature.FileName, feature.SHA256, feature.Source = source.path, source.name, source.sha256, source.packed
    feature.Language = next(text for text, dialect in LANGUAGES.items() if dialect == options.dialect)
    feature.Unit = next(text for text, unit in UNITS.items() if unit == options.unit)
    feature.Rapid, feature.Approach, feature.Further = options.rapid_mm_min, options.approach, options.further
    feature.AssumeG43, feature.BlockDelete = options.assume_g43, options.block_delete
