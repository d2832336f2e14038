"""Counts the fragments that a choice by register numbers would need, and those that exist, as JSON.

    python3 bench/claims/tools/fragments.py

A family like addRiRjRk has a fragment for each choice of the temporary registers of vs_2_0 as destination and
sources. The instructions are those of `triptych list shaders` whose operands are a destination and sources, and the
number of registers is that of src/def/shader/shader_register.def. The fragments that exist are the symbols
fragment_* in the project's objects; their registers are holes.
"""

import json
import os
import re
import shutil
import subprocess

ROW = re.compile(r'REGISTER\(TEMPORARY, +"r", +0, +NUMBERED, +\d+, +(\d+),')


def output(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def temporaries():
    with open("src/def/shader/shader_register.def", encoding="utf-8") as file:
        return int(ROW.search(file.read()).group(1))


def sources():
    """The number of sources of each instruction of vs_2_0 that has the form "add dst, a, b"."""
    rows = json.loads(output("triptych", "list", "shaders", "--json"))
    forms = [re.fullmatch(r"\w+ dst((, [a-d])+)", row["syntax"]) for row in rows if row["slots"].get("vs_2_0")]
    return [form.group(1).count(",") for form in forms if form]


def existing():
    library = os.path.join(os.path.dirname(os.path.realpath(shutil.which("triptych"))), "libtriptych.a")
    return len(set(re.findall(r" [A-Z] (fragment_\w+)$", output("nm", "--defined-only", library), re.M)))


def main():
    registers, counts = temporaries(), sources()
    result = {"registers": registers, "instructions": len(counts), "existing": existing()}
    result["add"] = registers**3
    result["by_register"] = sum(registers ** (1 + count) for count in counts)
    result["by_swizzle"] = sum(15 * registers * (256 * registers) ** count for count in counts)
    print(json.dumps(result, indent=1))


main()
