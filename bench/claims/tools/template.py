"""Builds a texture stage from a text with conditionals, and counts the lines of both forms, as JSON.

    python3 bench/claims/tools/template.py

bench/claims/programs/stage.template is compiled once for each state, as external specialisation does it. Every result is compared with the
formula of the operation. `text` and `specification` count lines of code of the stage in both forms; `conditionals` are those of the
preprocessor in the text.
"""

import ctypes
import json
import os
import re
import subprocess
import tempfile
import time

TEMPLATE = "bench/claims/programs/stage.template"
SPECIFICATION = ("src/spec/pixel/stage.h", "src/spec/math/color.h")


def scaled(a, b):
    return (2 * a * b + 255) // 510  # a * b / 255 to nearest


FORMULAS = {
    "SELECT": lambda a, b, c: a,
    "MODULATE": lambda a, b, c: scaled(a, b),
    "MODULATE_2X": lambda a, b, c: min(2 * scaled(a, b), 255),
    "MODULATE_4X": lambda a, b, c: min(4 * scaled(a, b), 255),
    "ADD": lambda a, b, c: min(a + b, 255),
    "ADD_SIGNED": lambda a, b, c: min(max(a + b - 128, 0), 255),
    "ADD_SIGNED_2X": lambda a, b, c: min(2 * max(a + b - 128, 0), 255),
    "SUBTRACT": lambda a, b, c: max(a - b, 0),
    "MULTIPLY_ADD": lambda a, b, c: min(c + scaled(a, b), 255),
}


def build(folder, operation, complement, alpha):
    """The function, and the seconds that its build took."""
    path = os.path.join(folder, f"{operation}-{complement}-{alpha}.so")
    state = [f"-DOPERATION={operation}", f"-DCOMPLEMENT={complement}", f"-DALPHA={alpha}"]
    begin = time.perf_counter()
    subprocess.run(["cc", "-x", "c", "-O2", "-w", "-shared", "-fPIC", *state, TEMPLATE, "-o", path], check=True)
    library = ctypes.CDLL(path)
    return library.stage, time.perf_counter() - begin


def is_right(stage, operation, complement, alpha):
    pairs = [(a, b, (a * 7 + b) % 256) for a in range(256) for b in range(0, 256, 5)]
    words = [(ctypes.c_uint * len(pairs))(*(pair[i] | (pair[i] ^ 255) << 16 for pair in pairs)) for i in range(3)]
    result = (ctypes.c_uint * len(pairs))()
    stage(*words, result, len(pairs))
    formula = FORMULAS[operation]
    for n, pair in enumerate(pairs):
        low, high = list(pair), [each ^ 255 for each in pair]
        if complement:
            low[0], high[0] = 255 - low[0], 255 - high[0]
        expected = formula(*(high if alpha else low)) | formula(*high) << 16
        if result[n] != expected:
            return 0
    return 1


def code_lines(text):
    return sum(1 for line in text.splitlines() if line.strip() and not re.match(r"\s*(//|/\*|\*)", line))


def function(text, name):
    match = re.search(rf"^static inline (?:fix|struct \w+) {name}\(.*?^}}\n", text, re.M | re.S)
    return match[0]


def specification():
    """The functions of the same operations: stage_combine and what it calls."""
    text = "".join(open(path, encoding="utf-8").read() for path in SPECIFICATION)
    found, work = {}, ["stage_combine"]
    while work:
        name = work.pop()
        if name in found or not re.search(rf"^static inline (?:fix|struct \w+) {name}\(", text, re.M):
            continue
        found[name] = function(text, name)
        work += re.findall(r"\b([a-z]\w+)\(E,", found[name])
    return sum(map(code_lines, found.values()))


def main():
    with open(TEMPLATE, encoding="utf-8") as file:
        text = file.read()
    states = [(operation, complement, alpha) for operation in FORMULAS for complement in (0, 1) for alpha in (0, 1)]
    builds = []
    with tempfile.TemporaryDirectory() as folder:
        for state in states:
            stage, seconds = build(folder, *state)
            builds.append({"state": "-".join(map(str, state)), "ms": seconds * 1000, "right": is_right(stage, *state)})
    conditionals = len(re.findall(r"^#(if|elif|else)", text, re.M))
    print(json.dumps({"builds": builds, "text": code_lines(text), "conditionals": conditionals, "specification": specification()}, indent=1))


main()
