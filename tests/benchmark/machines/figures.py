"""Figures that scripts measure: a JSON line as each is known, and the table at the end."""

import json


class Figures:
    def __init__(self):
        self.rows = []

    def add(self, name, value, unit, target=None, note=""):
        good = target is None or value <= target
        row = {"name": name, "value": value, "unit": unit, "target": "" if target is None else f"<= {target:g}", "ok": good}
        self.rows.append(row | ({"note": note} if note else {}))
        print(json.dumps(self.rows[-1]), flush=True)

    def table(self):
        print()
        for row in self.rows:
            verdict = "" if not row["target"] else "ok" if row["ok"] else "missed"
            print(f"{row['name']:<28} {row['value']:>12.6g}  {row['unit']:<8} {row['target']:<10} {verdict:<7} {row.get('note', '')}")
        return all(row["ok"] for row in self.rows)
