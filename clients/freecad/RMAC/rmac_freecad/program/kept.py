"""Programs in the document, saved with it."""


def keep(document, program, label):
    """As a text that FreeCAD shows; in one step that can be undone."""
    document.openTransaction(f"Keep {label}")
    kept = document.addObject("App::TextDocument", "Program")
    kept.Label = f"{label}.rmac"
    kept.Text = program.text()
    document.commitTransaction()
    return kept
