"""Figures that scripts measure: a JSON line as each is known, and the table at the end."""

import json


class Figures:
    def __init__(self):
        self.rows = []

    def add(self, name, value, unit, target=None, note=""):
        """At most `target`, where there is one."""
        good = target is None or value <= target
        self._add(name, value, unit, "" if target is None else f"<= {target:g}", good, note)

    def add_least(self, name, value, unit, target, note=""):
        self._add(name, value, unit, f">= {target:g}", value >= target, note)

    def _add(self, name, value, unit, target, good, note):
        row = {"name": name, "value": value, "unit": unit, "target": target, "ok": good}
        self.rows.append(row | ({"note": note} if note else {}))
        print(json.dumps(self.rows[-1]), flush=True)

    def table(self):
        print()
        for row in self.rows:
            verdict = "" if not row["target"] else "ok" if row["ok"] else "missed"
            print(f"{row['name']:<28} {row['value']:>12.6g}  {row['unit']:<8} {row['target']:<10} {verdict:<7} {row.get('note', '')}")
        return all(row["ok"] for row in self.rows)
