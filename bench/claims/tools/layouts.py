"""Counts the vector operations of shaders with one component, and with one pixel, to a register of four numbers, as JSON.

    python3 bench/claims/tools/layouts.py

The texts are those of `external` (a statement is one operation for all pixels of a register) and `external:c=pixels` (for one pixel).
Counts are for four pixels, so those of the second text count four times. `shuffles` are those that operands need, of the second text; the
first has none. Only what the shader's body adds counts: each count is that of the shader minus that of `mov r0, v0`. `whole` has whole
routines of streams.
"""

import json
import re
import subprocess

STREAM = """triptych 1
target 64 64
state cullmode none
state zenable false
shader through {
    vs_3_0
    dcl_position v0
    dcl_texcoord v1
    dcl_position o0
    dcl_texcoord o1
    mov o0, v0
    mov o1, v1
}
vertices some position:float4 texcoord:float4 {
    -1 1 0 1  -0.6 0.7 1 1
    1 1 0 1  0.8 0.5 1 1
    -1 -1 0 1  -0.5 -0.6 1 1
}
bind vertices some
vertexshader through
shader pixels {
    ps_3_0
    dcl_texcoord v0
    mov r0, v0
%s
    mov oC0, r0
}
pixelshader pixels
draw triangles 0 1
"""
BODIES = {
    "mov": "",
    "plain add": "mul r1, r0, r0\n    add r0, r0, r1",
    "swizzled add": "mul r1, r0, r0\n    add r0, r0, r1.wzyx",
    "masked add": "mul r1, r0, r0\n    add r0.xz, r0, r1.wzyx",
    "mul": "mul r0, r0, c5",
    "mad": "mad r0, r0, c5, v0",
    "dp3": "dp3 r0, r0, c5",
    "dp4": "dp4 r0, r0, c5",
    "nrm": "nrm r1, r0\n    mov r0, r1",
    "crs": "mov r2, v0.yzxw\n    crs r1.xyz, r0, r2\n    mov r0.xyz, r1",
    "m3x3": "m3x3 r1.xyz, r0, c2\n    mov r0.xyz, r1",
    "rcp": "rcp r0.x, r0.x",
}
WHOLE = ["highlights", "bricks", "water", "solids", "rays", "materials"]
STATEMENT = re.compile(r"^ +(?:(?:flt|itg|fix|msk) )?v\d+(?:\[i\])? = (.*); // ")


SHUFFLE = re.compile(r"shuffle\(\w+, ([^(),]+), ([^(),]+)(?:, \d){4}\)")
CONSTANT = re.compile(r"(flt|itg|fix|msk)_([0-9a-f]{8}|JOB_\d+|CONSTANT_\d+)$")


def shuffles_of(line):
    """The shuffles of a statement, without those of constants, which are done once."""
    count = 0
    line = re.sub(r"\bv(\d+)\[[^\]]*\]", r"v\1", line)
    line = re.sub(r"words_\w\([^()]*\)", "words", line)
    while match := SHUFFLE.search(line):
        constant = CONSTANT.match(match[1]) and CONSTANT.match(match[2])
        count += not constant
        line = line[: match.start()] + (match[1] if constant else "v0") + line[match.end() :]
    return count


def text(engine, stream, source):
    command = ["triptych", "dump", stream, "--unit", "pixel", "--engine", engine, "--show", "text"]
    output = subprocess.run(command, check=True, capture_output=True, text=True, input=source).stdout
    return output[output.index("ENTRY = read_pointer") :]


def count(stream, source=None):
    """Operations for four pixels: by component, by pixel, and the shuffles of the latter."""
    component = [match[1] for match in map(STATEMENT.match, text("external", stream, source).splitlines()) if match]
    pixel = [match[1] for match in map(STATEMENT.match, text("external:c=pixels", stream, source).splitlines()) if match]
    shuffles = sum(map(shuffles_of, pixel))
    component = [line for line in component if not line.startswith(("uniform", "(msk)uniform"))]
    pixel = [line for line in pixel if not line.startswith("uniform")]
    return {"component": len(component), "pixel": 4 * (len(pixel) + shuffles), "shuffles": 4 * shuffles}


def main():
    base = count("-", STREAM % "")
    rows = []
    for name, body in BODIES.items():
        counts = count("-", STREAM % ("    " + body))
        rows.append({"instruction": name} | {key: counts[key] - base[key] for key in counts})
    whole = [{"stream": name} | count(f"tests/data/shading/{name}.tri") for name in WHOLE]
    print(json.dumps({"instructions": rows, "whole": whole}, indent=1))


main()
