"""Counts the components that shaders and samples read, as JSON.

    python3 bench/claims/tools/components.py

`samples`: the interpolated components of a coordinate, in the recording of a pixel shader with one lookup. `shaders`: for each shader of
the project, its arithmetic instructions and those that write all four components.
"""

import glob
import json
import re
import subprocess
import tempfile

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
    -1 1 0 1  0 0 0.5 1
    1 1 0 1  1 0 0.5 1
    -1 -1 0 1  0 1 0.5 1
}
%s
bind texture 0 t
bind vertices some
vertexshader through
shader pixels {
    ps_3_0
    dcl_texcoord v0
    dcl_%s s0
    %s r0, v0, s0
    mov oC0, r0
}
pixelshader pixels
draw triangles 0 1
"""
PLAIN, CUBE, VOLUME = "texture t 2d A8R8G8B8 64 64 empty", "texture t cube A8R8G8B8 64 empty", "texture t volume A8R8G8B8 16 16 16 empty"
SAMPLES = [
    ("2d", PLAIN, "2d", "texld"),
    ("cube", CUBE, "cube", "texld"),
    ("volume", VOLUME, "volume", "texld"),
    ("2d projected", PLAIN, "2d", "texldp"),
    ("volume projected", VOLUME, "volume", "texldp"),
]
SKIPPED = re.compile(r"(if|else|endif|rep|endrep|loop|endloop|break|call|ret|label|def|dcl|phase|nop|end|tex|vs_|ps_)")


def run(*command, text=None):
    return subprocess.run(command, check=True, capture_output=True, text=True, input=text).stdout


def sample(name, texture, declared, instruction):
    stream = STREAM % (texture, declared, instruction)
    record = run("triptych", "dump", "-", "--unit", "pixel", "--engine", "specialize-8", "--show", "record", text=stream)
    sums = [line for line in record.splitlines() if "mad_f" in line and "interpolate.h" in line]
    return {"sample": name, "components": len(sums) // 2 - 1}  # two a plane; without that of 1/w


def shader(path):
    with tempfile.NamedTemporaryFile() as tokens:
        run("triptych", "shader", "assemble", path, "--out", tokens.name)
        lines = [line.strip() for line in run("triptych", "shader", "disassemble", tokens.name).splitlines()]
    code = [line for line in lines if line and not SKIPPED.match(line)]
    four = sum(1 for line in code if not re.search(r"\.[xyzw]{1,3}$", line.split(",")[0]))
    return {"shader": path, "arithmetic": len(code), "four": four}


def main():
    paths = sorted(glob.glob("tests/data/shaders/*/*.vsa") + glob.glob("tests/data/shaders/*/*.psa"))
    result = {"samples": [sample(*row) for row in SAMPLES], "shaders": [shader(path) for path in paths]}
    print(json.dumps(result, indent=1))


main()
