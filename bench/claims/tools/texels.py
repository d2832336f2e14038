"""Counts cache misses and instructions of textures in rows and in tiles, by valgrind's cachegrind, as JSON.

    python3 bench/claims/tools/texels.py

Draws a square of 256 x 256 pixels with a texture of 512 x 512 texels, a texel a pixel, turned by 0, 45 and 90
degrees and added to the target. The counts are those of a layer: a frame with five layers less a frame with
one, divided by four. The caches are those of the machine.
"""

import json
import math
import os
import re
import subprocess
import sys
import tempfile

SIZE, TEXELS, LAYERS = 256, 512, 5

STREAM = """triptych 1
target {size} {size}
texture noise 2d A8R8G8B8 {texels} {texels} levels 1 checker 3 ffffffff ff203040
vertices square position:float3 texcoord:float2 {{
{vertices}}}
state lighting false
state cullmode none
state zenable false
state alphablendenable true
state srcblend one
state destblend one
sampler 0 magfilter point
sampler 0 minfilter point
stage 0 colorop selectarg1
bind vertices square
bind texture noise
clear color 0 0 0 1
{draws}frame
"""

COUNT = re.compile(r"(I\s+refs|D1\s+misses|LLd misses):\s+([0-9,]+)")


def corner(x, y, degrees):
    """The coordinates at a corner: one texel for a pixel, turned around the middle."""
    angle = math.radians(degrees)
    u = x * math.cos(angle) - y * math.sin(angle)
    v = x * math.sin(angle) + y * math.cos(angle)
    scale = SIZE / 2 / TEXELS
    return f"    {x} {-y} 0.5  {0.5 + u * scale:.7f} {0.5 + v * scale:.7f}\n"


def stream(degrees, layers):
    """The text of a stream."""
    vertices = "".join(corner(x, y, degrees) for x in (-1, 1) for y in (-1, 1))
    return STREAM.format(size=SIZE, texels=TEXELS, vertices=vertices, draws="draw strip 0 2\n" * layers)


def counts(path, order):
    """Instructions, and misses of the first and the last cache, of one frame."""
    command = ["valgrind", "--tool=cachegrind", "--cache-sim=yes", "--cachegrind-out-file=/dev/null",
               "triptych", "render", path, "--engine", "specialize-8", "--threads", "1", "--set", f"texels={order}",
               "--out", "-", "--compression", "0"]
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
    found = {name.split()[0]: int(number.replace(",", "")) for name, number in COUNT.findall(done.stderr)}
    if done.returncode or len(found) != 3:
        sys.exit(f"{' '.join(command)}: status {done.returncode}, expected counts\n{done.stderr}")
    return found


def walk(folder, degrees, order):
    """The counts of a layer, a pixel or 1000 pixels."""
    path, several = os.path.join(folder, "square.tri"), []
    for layers in (1, LAYERS):
        with open(path, "w", encoding="utf-8") as file:
            file.write(stream(degrees, layers))
        several.append(counts(path, order))
    layer = {name: (several[1][name] - several[0][name]) / (LAYERS - 1) / SIZE**2 for name in several[0]}
    return {"degrees": degrees, "layout": order, "instructions": layer["I"], "misses": 1000 * layer["D1"],
            "memory": 1000 * layer["LLd"]}


def main():
    """Prints the counts of both orders at three angles."""
    with tempfile.TemporaryDirectory() as folder:
        walks = [walk(folder, degrees, order) for degrees in (0, 45, 90) for order in ("rows", "tiles")]
    json.dump({"walks": walks}, sys.stdout, indent=1)
    print()


if __name__ == "__main__":
    main()
