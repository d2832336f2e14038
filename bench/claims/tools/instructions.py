"""Counts what single shader instructions become, as JSON.

    python3 bench/claims/tools/instructions.py

For each instruction below: the operations that are recorded for it, and the machine
instructions of the specializer with 4 and with 8 lanes. Each count is that of a pixel shader with the instruction minus that of the shader
without it, in the same draw; a shader that only moves its input has the count 0. `kinds` lists the recorded operations.
"""

import collections
import json
import re
import subprocess

STREAM = """triptych 1
target 64 64 depth d24x8
convention depthrange minus
state lighting false
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
vertices quad position:float4 texcoord:float4 {
    -1 1 0 1  -0.6 0.7 1 1
    1 1 0 1  0.8 0.5 1 1
    -1 -1 0 1  -0.5 -0.6 1 1
    1 -1 0 1  0.9 -0.8 1 1
}
texture t 2d A8R8G8B8 64 64 empty
bind texture 0 t
sampler 0 minfilter linear
sampler 0 magfilter linear
bind vertices quad
vertexshader through
shader pixels {
    ps_3_0
    def c0, 3, 0, 0, 0
    def c1, 0.5, 0.25, 2, 1
    dcl_texcoord v0
    dcl_2d s0
    mov r0, v0
%s
    mov oC0, r0
}
pixelshader pixels
draw strip 0 2
"""

INSTRUCTIONS = {
    "mov": "",
    "add": "add r0, r0, c1",
    "mul": "mul r0, r0, c1",
    "mad": "mad r0, r0, c1, v0",
    "min": "min r0, r0, c1",
    "max": "max r0, r0, c1",
    "frc": "frc r0, r0",
    "dp3": "dp3 r0.x, r0, c1",
    "dp4": "dp4 r0.x, r0, c1",
    "rcp": "rcp r0.x, r0.x",
    "rsq": "rsq r0.x, r0.x",
    "exp": "exp r0.x, r0.x",
    "log": "log r0.x, r0.x",
    "pow": "pow r0.x, r0.x, r0.y",
    "pow of a constant": "pow r0.x, c0.x, r0.x",
    "sincos": "sincos r1.x, r0.x\n    mov r0.x, r1.x",
    "nrm": "nrm r1, r0\n    mov r0, r1",
    "crs": "mov r2, v0.yzxw\n    crs r1.xyz, r0, r2\n    mov r0.xyz, r1",
    "m4x4": "m4x4 r1, r0, c0\n    mov r0, r1",
    "swizzled add": "mul r1, r0, r0\n    add r0, r0, r1.wzyx",
    "plain add": "mul r1, r0, r0\n    add r0, r0, r1",
    "masked add": "mul r1, r0, r0\n    add r0.xz, r0, r1.wzyx",
    "texld": "texld r0, r0, s0",
}
RECORDED = re.compile(r"^ *\d+  (\w+)? +(\w+)")
MACHINE = re.compile(r"^ +[0-9a-f]+  [a-z]")


def sections(text):
    """The dump's sections by their names."""
    found, lines = {}, []
    for line in text.splitlines():
        if line.startswith("== "):
            lines = found[line[3:].split(":")[0]] = []
        else:
            lines.append(line)
    return found


def dump(body, engine, stages):
    stream = STREAM % "\n".join("    " + line.strip() for line in body.splitlines())
    command = ["triptych", "dump", "-", "--unit", "pixel", "--engine", engine, "--show", ",".join(stages)]
    output = subprocess.run(command, input=stream, capture_output=True, text=True, check=False)
    if output.returncode:
        raise SystemExit(f"{body}: {output.stderr.strip()}")
    return sections(output.stdout)


def measure(body):
    eight = dump(body, "specialize-8", ("record", "asm"))
    four = dump(body, "specialize-4", ("asm",))
    operations = [match[2] for match in map(RECORDED.match, eight["record"]) if match]
    return {
        "recorded": len(operations),
        "lanes_8": sum(1 for line in eight["asm"] if MACHINE.match(line)),
        "lanes_4": sum(1 for line in four["asm"] if MACHINE.match(line)),
        "kinds": collections.Counter(operations),
    }


def difference(counts, base):
    result = {name: counts[name] - base[name] for name in ("recorded", "lanes_8", "lanes_4")}
    result["kinds"] = {kind: count for kind, count in (counts["kinds"] - base["kinds"]).items()}
    return result


def main():
    base = measure("")
    rows = [{"instruction": name} | difference(measure(body), base) for name, body in INSTRUCTIONS.items()]
    print(json.dumps({"instructions": rows}, indent=1))


main()
