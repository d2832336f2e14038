"""Tries four rules of strength reduction on edge values of IEEE arithmetic, as JSON: the values for which a rule changes a bit.

    python3 bench/claims/tools/algebra.py
"""

import json
import struct

VALUES = [0.0, 5e-324, 2.2250738585072014e-308, 0.1, 1.0, 3.0, 1.7976931348623157e308, float("inf"), float("nan")]
VALUES += [-each for each in VALUES]
RULES = {
    "y * 1 = y": (lambda y: y * 1.0, lambda y: y),
    "y + 0 = y": (lambda y: y + 0.0, lambda y: y),
    "y * 0 = 0": (lambda y: y * 0.0, lambda y: 0.0),
    "y - y = 0": (lambda y: y - y, lambda y: 0.0),
}


def bits(value):
    return struct.pack("<d", value)


rows = []
for name, (computed, reduced) in RULES.items():
    wrong = [repr(y) for y in VALUES if bits(computed(y)) != bits(reduced(y))]
    rows.append({"rule": name, "exceptions": len(wrong), "values": " ".join(wrong)})
print(json.dumps({"rules": rows}, indent=1))
