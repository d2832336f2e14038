"""The price of exactness: the cost and the errors of functions of pixels, by the state `precision`, as JSON.

    python3 bench/claims/tools/precision.py

For each scene and precision: the instructions of the pixel routine of specialize-8, and the difference of the
picture to the exact one: PSNR in dB, and the share of pixels in % of which a channel differs by more than 4
of 255. `far` is a floor with a repeated texture, `near` the same floor seen from a hundredth of a unit above it,
`functions` a pixel shader with reciprocals, roots, powers and logarithms.
"""

import json
import os
import subprocess
import sys
import tempfile

LEVELS = ("exact", "partial", "approximate")

FLOOR = """triptych 1
target 256 256
texture board 2d A8R8G8B8 256 256 levels 1 checker 16 ffffffff ff203040
vertices floor position:float3 diffuse:color texcoord:float2 {{
    -20 0 -20 ffff8080 0 0
    -20 0 20 ff80ff80 0 40
    20 0 -20 ff8080ff 40 0
    20 0 20 ffffffff 40 40
}}
state precision {precision}
state lighting false
state cullmode none
sampler 0 magfilter linear
sampler 0 minfilter linear
transform view lookat 0 {height} 0  0 0 {ahead}  0 1 0
transform projection perspective 60 1 {near} 100
bind vertices floor
bind texture board
clear color 0 0 0 1 depth 1
draw strip 0 2
frame
"""

FUNCTIONS = """triptych 1
target 256 256
vertices square position:float3 texcoord:float2 {{
    -1 -1 0 0.1 0.1
    -1 1 0 0.1 4
    1 -1 0 4 0.1
    1 1 0 4 4
}}
shader functions {{
    ps_2_0
    def c0, 0.25, 0.0625, 1, 8
    dcl t0.xy
    mov r0.xy, t0
    mov r0.z, c0.z
    nrm r1.xyz, r0
    pow r2.x, r1.z, c0.w
    rcp r3.x, t0.x
    exp r3.y, -t0.y
    mul r4.x, r2.x, c0.z
    mul r4.y, r3.x, c0.y
    mov r4.z, r3.y
    mov r4.w, c0.z
    mov oC0, r4
}}
state precision {precision}
state cullmode none
pixelshader functions
bind vertices square
clear color 0 0 0 1 depth 1
draw strip 0 2
frame
"""

SCENES = {
    "far": lambda precision: FLOOR.format(precision=precision, height=3, ahead=6, near=0.1),
    "near": lambda precision: FLOOR.format(precision=precision, height=0.01, ahead=0.02, near=0.001),
    "functions": lambda precision: FUNCTIONS.format(precision=precision),
}


def run(*command):
    """The output of a command of triptych; `compare` ends with 1 if pictures differ."""
    done = subprocess.run(["triptych", *command], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1):
        sys.exit(f"triptych {' '.join(command)}: status {done.returncode}\n{done.stderr}")
    return done.stdout


def measure(folder, scene, precision):
    """The instructions of the pixel routine, and the difference to the exact picture."""
    names = ("scene.tri", f"{precision}.png", "exact.png")
    path, picture, exact = (os.path.join(folder, name) for name in names)
    with open(path, "w", encoding="utf-8") as file:
        file.write(SCENES[scene](precision))
    run("render", path, "--engine", "specialize-8", "--out", picture)
    code = json.loads(run("bench", path, "--code", "--engines", "specialize-8", "--json", "-"))
    limits = ("--tolerance", "4", "--allow", "65536")
    compared = json.loads(run("compare", exact, picture, *limits, "--json", "-"))
    pixel = next(routine for routine in code["routines"] if routine["unit"] == "pixel")
    return {"scene": scene, "precision": precision, "instructions": pixel["instructions"],
            "psnr": compared.get("psnr", 99), "largest": compared.get("largest", 0),
            "beyond": 100 * compared.get("pixels_beyond_tolerance", 0) / 65536}


def main():
    """Prints a row for each scene and precision."""
    with tempfile.TemporaryDirectory() as folder:
        rows = [measure(folder, scene, precision) for scene in SCENES for precision in LEVELS]
    json.dump({"rows": rows}, sys.stdout, indent=1)
    print()


if __name__ == "__main__":
    main()
