"""Counts the lines of code of two engines and the bugs planted in them, as JSON.

    python3 bench/claims/tools/hands.py

`lines` counts lines that are neither empty nor comments only. `planted` and `survived` are rows of results/mutations.md whose place is in
the folders of the engine; a bug survives if no test is named.
"""

import json
import pathlib
import re

ENGINES = {
    "stitch": ("asm/stitch", "src/engines/stitch"),
    "specialize": ("src/engines/specialize",),
}
COMMENT = re.compile(r"\s*(;|/\*|\*|//|$)")


def lines_of(folder):
    files = [path for path in pathlib.Path(folder).rglob("*") if path.suffix in (".c", ".h", ".asm", ".inc")]
    return sum(1 for path in files for line in path.read_text(encoding="utf-8").splitlines() if not COMMENT.match(line))


def bugs():
    for line in pathlib.Path("results/mutations.md").read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.split("|")]
        if len(cells) > 6 and "`" in cells[2]:
            yield cells[2].strip("`"), cells[4]


def main():
    planted = list(bugs())
    rows = []
    for name, folders in ENGINES.items():
        here = [found for place, found in planted if place.startswith(folders)]
        survived = sum(1 for found in here if not found.startswith("tests/"))
        rows.append({"engine": name, "lines": sum(map(lines_of, folders)), "planted": len(here), "survived": survived})
    print(json.dumps({"engines": rows}, indent=1))


main()
