"""Files of other controls, opened and shown."""
