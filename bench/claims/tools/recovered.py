"""Counts what gcc -O3 makes of plain C: which operations and which loops over lanes become vectors, as JSON.

    python3 bench/claims/tools/recovered.py

`operations`: each operation of src/def/op.def in a loop over arrays by itself, as external:c=plain prints it. `routines`: the loops over
lanes in pixel and vertex routines of streams, and the vector and scalar arithmetic instructions of the code. gcc reports the loops that
it has vectorised (-fopt-info-vec); a loop that it writes out for single lanes instead is not counted.
"""

import json
import os
import re
import subprocess
import tempfile

FLAGS = ["-std=c11", "-O3", "-mavx2", "-mfma", "-mf16c", "-mno-avx512f", "-ffp-contract=off", "-fno-ipa-icf", "-fno-math-errno", "-fno-trapping-math", "-w"]
ROUTINES = [
    ("bench/streams/teapot-bilinear.tri", "pixel"),
    ("bench/streams/bunny.tri", "vertex"),
    ("bench/streams/cat.tri", "pixel"),
    ("tests/data/shading/highlights.tri", "pixel"),
    ("tests/data/shading/bricks.tri", "pixel"),
    ("tests/data/shading/ocean.tri", "vertex"),
]
FUNCTION = re.compile(r"^static inline (flt|itg|msk|fix) (\w+_[fixm])\(([^)]*)\)$", re.M)
SCALAR = re.compile(r"\tv\w+(ss|sd)\b")
PACKED = re.compile(r"\tv(?!mov|broadcast|insert|extract|perm|unpck|shuf|zero)\w+.*%ymm")


def compile_text(text, folder):
    """The lines with vectorised loops, and the disassembly."""
    source, object_file = os.path.join(folder, "t.c"), os.path.join(folder, "t.o")
    with open(source, "w", encoding="utf-8") as file:
        file.write(text)
    report = subprocess.run(["gcc", *FLAGS, "-fopt-info-vec", "-c", source, "-o", object_file], check=True, capture_output=True, text=True)
    code = subprocess.run(["objdump", "-d", object_file], check=True, capture_output=True, text=True).stdout
    return {int(line) for line in re.findall(r":(\d+):\d+: optimized: loop vectorized", report.stderr)}, code


def dump(stream, unit):
    command = ["triptych", "dump", stream, "--unit", unit, "--engine", "external:c=plain", "--show", "whole"]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    return text[text.index("/* The beginning of the texts") :]  # a shader is printed before it


def operations(beginning, folder):
    functions, text = [], beginning
    for result, name, parameters in FUNCTION.findall(beginning[beginning.index("The operations of def/op.def") :]):
        types = [each.split()[0] for each in parameters.split(", ")]
        values = [kind for kind in types if kind != "int"]
        arrays = ", ".join(f"const {kind} *restrict {'abc'[n]}" for n, kind in enumerate(values))
        arguments = ", ".join([f"{'abc'[n]}[i]" for n in range(len(values))] + ["3"] * ("int" in types))
        text += f"void loop_{name}({arrays}, {result} *restrict r)\n{{\nfor (int i = 0; i < 64; i++) r[i] = {name}({arguments});\n}}\n"
        functions.append((name, text.count("\n") - 1))
    vectors, _ = compile_text(text, folder)
    return [{"operation": name, "vector": int(line in vectors)} for name, line in functions]


def routine(stream, unit, folder):
    text = dump(stream, unit)
    vectors, code = compile_text(text, folder)
    start = text[: text.index("void routine(")].count("\n")
    loops = [n for n, line in enumerate(text.split("\n"), 1) if n > start and "for (int i = 0; i < WIDTH; i++)" in line]
    lines = code.split("\n")
    return {
        "stream": stream,
        "unit": unit,
        "loops": len(loops),
        "vector": sum(1 for n in loops if n in vectors),
        "packed": sum(1 for line in lines if PACKED.search(line)),
        "scalar": sum(1 for line in lines if SCALAR.search(line) and "vmov" not in line),
    }


def main():
    with tempfile.TemporaryDirectory() as folder:
        text = dump(*ROUTINES[0])
        beginning = text[: text.index("void routine(")]
        result = {"operations": operations(beginning, folder), "routines": [routine(stream, unit, folder) for stream, unit in ROUTINES]}
    print(json.dumps(result, indent=1))


main()
