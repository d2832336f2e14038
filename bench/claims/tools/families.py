"""Writes families of draw streams that differ in one number.

    python3 bench/claims/tools/families.py FOLDER

stages-1 ... stages-8     a rectangle with so many texture stages that multiply the factor
lights-0 ... lights-8     the teapot with this number of directional lights; lights-off has eight that are off
opaque-1 ... opaque-16    layers that cover the target, each opaque
blended-1 ... blended-16  the same, blended
"""

import os
import sys

TARGET = """triptych 1
target 512 512 depth d24x8
convention depthrange minus
state cullmode none
"""
RECTANGLE = (
    TARGET
    + """state lighting false
state zenable false
state texturefactor 0xc04080c0
vertices quad position:float4 texcoord:float2 {
    -1  1 0 1   0 0
     1  1 0 1   1 0
    -1 -1 0 1   0 1
     1 -1 0 1   1 1
}
bind vertices quad
clear color 0 0 0 1 depth 1
"""
)
TEAPOT = (
    TARGET
    + """mesh teapot bezier "%s/bench/streams/assets/teapot.bez" subdivisions 12 center fit 2
transform view lookat-rh 0.70 -2.20 1.08  0.02 0 -0.02  0 0 1
transform projection perspective-rh 40 1 0.5 10
state normalizenormals true
material diffuse 1 1 1 1 ambient 1 1 1 1
state lighting true
clear color 0 0 0 1 depth 1
"""
)


def stages(count):
    lines = ["stage 0 colorop selectarg1", "stage 0 colorarg1 tfactor"]
    for stage in range(1, count):
        lines += [f"stage {stage} colorop modulate", f"stage {stage} colorarg1 tfactor", f"stage {stage} colorarg2 current"]
        lines += [f"stage {stage} alphaop selectarg1", f"stage {stage} alphaarg1 current"]
    return RECTANGLE + "\n".join(lines + ["draw strip 0 2", ""])


def lights(count, on):
    lines = []
    for light in range(count):
        lines.append(f"light {light} directional diffuse 0.2 0.2 0.2 1 direction {0.1 * light:.1f} 0.8 -0.65")
        lines.append(f"light {light} {'on' if on else 'off'}")
    return TEAPOT % os.getcwd() + "\n".join(lines + ["draw mesh teapot", ""])


def layers(count, blended):
    lines = ["stage 0 colorop selectarg1", "stage 0 colorarg1 tfactor", "stage 0 alphaop selectarg1", "stage 0 alphaarg1 tfactor"]
    if blended:
        lines += ["state alphablendenable true", "state srcblend srcalpha", "state destblend invsrcalpha"]
    return RECTANGLE + "\n".join(lines + ["draw strip 0 2"] * count + [""])


def main():
    folder = sys.argv[1]
    os.makedirs(folder, exist_ok=True)
    streams = {f"stages-{n}": stages(n) for n in (1, 2, 4, 8)}
    streams |= {f"lights-{n}": lights(n, True) for n in (0, 1, 2, 4, 8)} | {"lights-off": lights(8, False)}
    streams |= {f"opaque-{n}": layers(n, False) for n in (1, 2, 4, 8, 16)}
    streams |= {f"blended-{n}": layers(n, True) for n in (1, 2, 4, 8, 16)}
    for name, text in streams.items():
        with open(os.path.join(folder, name + ".tri"), "w", encoding="utf-8") as file:
            file.write(text)


main()
