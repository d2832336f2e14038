"""A page as a browser draws it: rectangles of two triangles in batches of equal state, written as a draw stream."""

import os
import subprocess
import tempfile

SIDE = 1024

VERTEX = """vs_3_0
def c1, 0, 1, 0, 0
dcl_position v0
dcl_color v1
dcl_texcoord v2
dcl_position o0
dcl_color o1
dcl_texcoord o2.xy
mad o0.xy, v0, c0, c0.zwzw
mov o0.zw, c1.xxxy
mov o1, v1
mov o2.xy, v2"""

# The same for the stages of fixed function, which do not follow a shader of model 3.
PLAIN = VERTEX.replace("vs_3_0", "vs_2_0").replace("dcl_position o0\ndcl_color o1\ndcl_texcoord o2.xy\n", "")
for register, name in ("o0", "oPos"), ("o1", "oD0"), ("o2", "oT0"):
    PLAIN = PLAIN.replace(register, name)

# Places within a rounded rectangle: x and y from its centre, its half sides less the radius, the radius and 1/2.
ROUND = VERTEX.replace("dcl_position o0", "dcl_texcoord1 v3\ndcl_texcoord2 v4\ndcl_position o0").replace(
    "mad o0", "dcl_texcoord1 o3\ndcl_texcoord2 o4.x\nmad o0"
) + "\nmov o3, v3\nmov o4.x, v4.x"

COVERAGE = """abs r1.xy, v2
sub r1.xy, r1, v2.zwzw
max r1.xy, r1, c0.x
dp2add r1.x, r1, r1, c0.y
rsq r1.y, r1.x
mad_sat r1.x, -r1.x, r1.y, v3.x"""
CORNERS = "def c0, 0, 1e-6, 0, 0\ndcl_color v0\ndcl_texcoord v1.xy\ndcl_texcoord1 v2\ndcl_texcoord2 v3.x\n"

# Colours are multiplied by their alpha. By name, the states of stage 0: a product of bytes needs no shader, and
# renderers of rectangles compute it in bytes.
STAGES = {
    "solid": {"colorop": "disable"},
    "image": {"colorop": "modulate", "colorarg1": "texture"},
    "mask": {"colorop": "modulate", "colorarg1": "texture_alphareplicate"},
}

# By name: the vertex shader, the pixel shader.
SHADERS = {
    # The coverage of the three stripes of a pixel. The second colour is each channel's share of the ink.
    "subpixel": ("flat", "dcl_color v0\ndcl_texcoord v1.xy\ndcl_2d s0\ntexld r0, v1, s0\nmul oC0, v0, r0\nmul oC1, r0, v0.w"),
    "line": ("flat", "dcl_color v0\ndcl_texcoord v1.xy\nadd_sat r0.x, v1.y, -v1_abs.x\nmul oC0, v0, r0.x"),
    "rounded": ("round", CORNERS + COVERAGE + "\nmul oC0, v0, r1.x"),
    "rounded-image": (
        "round",
        CORNERS + "dcl_2d s0\ntexld r0, v1, s0\nmul r0, r0, v0\n" + COVERAGE + "\nmul oC0, r0, r1.x",
    ),
}


def vertex_shader(name):
    return "plain" if name in STAGES else SHADERS[name][0]


def color(red, green, blue, alpha=1.0):
    """A colour of 0 to 255 and its alpha, multiplied by it: AARRGGBB."""
    return "".join(f"{round(each):02x}" for each in (alpha * 255, red * alpha, green * alpha, blue * alpha))


def grey(value, alpha=1.0):
    return color(value, value, value, alpha)


def linear(first, last, across, down):
    """The colours of the corners of a linear gradient, which grows by these amounts across and down: their sum is 1.
    A gradient is a plane of colour, so each triangle of a rectangle has the same one."""
    ends = [[int(each[i : i + 2], 16) for i in (0, 2, 4, 6)] for each in (first, last)]
    corners = []
    for part in (0, across, down, 1):
        exact = [a + (b - a) * part for a, b in zip(*ends)]
        if any(each != round(each) for each in exact):
            raise SystemExit(f"pages: the gradient from {first} to {last} has no bytes at its corners")
        corners.append("".join(f"{round(each):02x}" for each in exact))
    return corners


WHITE = "ffffffff"


class Batch:
    """Draws of equal state: a range of the indices of flat or round vertices."""

    def __init__(self, state, kind, first, shaded):
        self.state, self.kind, self.first, self.count = state, kind, first, 0
        self.shaded = shaded  # the colours of a rectangle's corners differ


class Page:
    def __init__(self, name, comment, atlas):
        self.name, self.comment, self.atlas = name, comment, atlas
        self.textures, self.opaque = {}, set()
        self.vertices = {"flat": [], "round": []}
        self.indices = {"flat": [], "round": []}
        self.frames, self.damage = [], None

    # --- Textures ---

    def texture(self, name, form, width, height, data):
        self.textures[name] = (form, width, height, bytes(data))

    def picture(self, name, image):
        """A picture of PIL, its colours multiplied by alpha."""
        data, pixels = bytearray(), list(image.convert("RGBA").getdata())
        if all(each[3] == 255 for each in pixels):
            self.opaque.add(name)
        for red, green, blue, alpha in pixels:
            data += bytes(round(each * alpha / 255) for each in (blue, green, red)) + bytes((alpha,))
        self.texture(name, "A8R8G8B8", *image.size, data)

    # --- Frames ---

    def frame(self, damage=None, move=None, clear=None):
        """Begins a frame. Only the damaged rectangle is drawn, after a copy of a part of the target: x, y, width,
        height, and the new x and y."""
        self.damage = damage
        self.frames.append({"damage": damage, "move": move, "clear": clear, "batches": []})

    def visible(self, x, y, width, height):
        left, top, wide, high = self.damage or (0, 0, SIDE, SIDE)
        return x < left + wide and left < x + width and y < top + high and top < y + height

    def batch(self, kind, *state, shaded=False):
        batches = self.frames[-1]["batches"]
        if not batches or (batches[-1].state, batches[-1].shaded) != (state, shaded):
            batches.append(Batch(state, kind, len(self.indices[kind]), shaded))
        return batches[-1]

    def corners(self, batch, vertices, order=(0, 1, 2, 2, 1, 3)):
        kind = batch.kind
        base = len(self.vertices[kind])
        self.vertices[kind] += vertices
        self.indices[kind] += [base + i for i in order]
        batch.count += len(order)

    # --- Drawing ---

    def quad(self, shader, texture, filters, blend, x, y, width, height, colors, u=(0, 1), v=(0, 1)):
        """colors: one, or those of the corners upper left, upper right, lower left, lower right."""
        if not self.visible(x, y, width, height):
            return
        shaded = not isinstance(colors, str)
        colors = colors if shaded else [colors] * 4
        batch = self.batch("flat", shader, texture, filters, blend, shaded=shaded)
        places = [(x, y), (x + width, y), (x, y + height), (x + width, y + height)]
        texels = [(u[0], v[0]), (u[1], v[0]), (u[0], v[1]), (u[1], v[1])]
        self.corners(batch, [(*place, ink, *at) for place, ink, at in zip(places, colors, texels)])

    def gradient(self, x, y, width, height, colors):
        """colors: of linear()."""
        self.quad("solid", None, "point", any(each[:2] != "ff" for each in colors), x, y, width, height, colors)

    def rectangle(self, x, y, width, height, ink):
        self.quad("solid", None, "point", ink[:2] != "ff", x, y, width, height, ink)

    def image(self, texture, x, y, width, height, ink=WHITE, filters="linear", u=(0, 1), v=(0, 1)):
        blend = texture not in self.opaque or ink[:2] != "ff"
        self.quad("image", texture, filters, blend, x, y, width, height, ink, u, v)

    def rounded(self, x, y, width, height, radius, ink, texture=None, filters="linear", u=(0, 1), v=(0, 1)):
        """Only the corners need the shader that rounds them; all else is plain, unless the colours differ."""
        whole = (0, 0, width, height)
        if not isinstance(ink, str) or 2 * radius >= min(width, height):
            corners, plain = [whole], []
        else:
            right, lower = width - radius, height - radius
            corners = [(left, top, radius, radius) for top in (0, lower) for left in (0, right)]
            plain = [(radius, 0, width - 2 * radius, radius), (0, radius, width, height - 2 * radius),
                     (radius, lower, width - 2 * radius, radius)]  # fmt: skip
        for left, top, wide, high in plain:
            if texture:
                across = [u[0] + (u[1] - u[0]) * each / width for each in (left, left + wide)]
                down = [v[0] + (v[1] - v[0]) * each / height for each in (top, top + high)]
                self.image(texture, x + left, y + top, wide, high, ink, filters, across, down)
            else:
                self.rectangle(x + left, y + top, wide, high, ink)
        for part in corners:
            self.round_part((x, y, width, height), part, radius, ink, texture, filters, u, v)

    def round_part(self, whole, part, radius, ink, texture, filters, u, v):
        """A part of a rounded rectangle, relative to its corner."""
        x, y, width, height = whole
        left, top, wide, high = part
        if not self.visible(x + left, y + top, wide, high):
            return
        shaded = not isinstance(ink, str)
        batch = self.batch("round", "rounded-image" if texture else "rounded", texture, filters, True, shaded=shaded)
        colors = ink if shaded else [ink] * 4
        vertices = []
        for i in range(4):
            across, down = left + wide * (i % 2), top + high * (i // 2)
            vertices.append((
                x + across, y + down, colors[i], u[0] + (u[1] - u[0]) * across / width, v[0] + (v[1] - v[0]) * down / height,
                across - width / 2, down - height / 2, width / 2 - radius, height / 2 - radius, radius + 0.5,
            ))  # fmt: skip
        self.corners(batch, vertices)

    def shadow(self, x, y, width, height, blur, ink):
        """The texture "shadow", a blurred square of 64 texels with a border of 24, as nine parts. The middle one is
        below what has the shadow, so it is not drawn."""
        across = [(x - blur, 0), (x + blur, 0.5), (x + width - blur, 0.5), (x + width + blur, 1)]
        down = [(y - blur, 0), (y + blur, 0.5), (y + height - blur, 0.5), (y + height + blur, 1)]
        for row, ((top, above), (bottom, below)) in enumerate(zip(down, down[1:])):
            for column, ((left, before), (right, after)) in enumerate(zip(across, across[1:])):
                if (row != 1 or column != 1) and left < right and top < bottom:
                    self.quad("mask", "shadow", "linear", True, left, top, right - left, bottom - top, ink, (before, after), (above, below))

    def text(self, face, size, x, baseline, words, ink):
        """Returns the place after the text. Glyphs are drawn from the atlas, texel by texel."""
        side = self.atlas.side
        for number, _, place, down, advance in self.atlas.faces[face].shape(words, size):
            quarters = round((x + place) * 4)
            found = self.atlas.glyph(face, size, number, quarters % 4)
            if found:
                u, v, width, height, left, top = found
                at = quarters // 4 + left, round(baseline + down) - top
                self.quad("subpixel" if self.atlas.subpixel else "mask", "glyphs", "point", True, *at, width, height, ink,
                          (u / side, (u + width) / side), (v / side, (v + height) / side))  # fmt: skip
            end = x + place + advance
        return end

    def line(self, points, width, ink):
        """Lines of a width in pixels, a rectangle each, with edges that fade across a pixel."""
        half = width / 2 + 1
        for (ax, ay), (bx, by) in zip(points, points[1:]):
            length = ((bx - ax) ** 2 + (by - ay) ** 2) ** 0.5
            if not length or not self.visible(min(ax, bx) - half, min(ay, by) - half, abs(bx - ax) + width + 2, abs(by - ay) + width + 2):
                continue
            across = -(by - ay) / length * half, (bx - ax) / length * half
            batch = self.batch("flat", "line", None, "point", True)
            self.corners(batch, [
                (ax - across[0], ay - across[1], ink, -half, width / 2 + 0.5), (bx - across[0], by - across[1], ink, -half, width / 2 + 0.5),
                (ax + across[0], ay + across[1], ink, half, width / 2 + 0.5), (bx + across[0], by + across[1], ink, half, width / 2 + 0.5),
            ])  # fmt: skip

    def polygon(self, points, triangles, ink):
        batch = self.batch("flat", "solid", None, "point", False)
        self.corners(batch, [(*point, ink, 0, 0) for point in points], [i for each in triangles for i in each])

    # --- The stream ---

    def write(self, folder, command):
        """Writes the container FOLDER/page-NAME.trib."""
        with tempfile.NamedTemporaryFile("w", suffix=".tri") as file:
            file.write("\n".join(self.stream()) + "\n")
            file.flush()
            path = os.path.join(folder, f"page-{self.name}.trib")
            subprocess.run([command, "convert", file.name, path], check=True)
        print(f"{path}: {os.path.getsize(path)} bytes, {sum(map(len, self.indices.values())) // 3} triangles, "
              f"{[len(frame['batches']) for frame in self.frames]} draws")  # fmt: skip

    def stream(self):
        yield "triptych 1"
        yield from ("# " + line for line in self.comment.strip().splitlines())
        yield f"target {SIDE} {SIDE} depth none"
        form = "A8R8G8B8" if self.atlas.subpixel else "A8"
        self.texture("glyphs", form, self.atlas.side, self.atlas.side, self.atlas.bytes)
        used = {batch.state[1] for frame in self.frames for batch in frame["batches"]}
        for name, (form, width, height, data) in self.textures.items():
            if name in used:
                yield f"texture {name} 2d {form} {width} {height} bytes {{"
                yield from (data[i : i + 128].hex() for i in range(0, len(data), 128))
                yield "}"
        drawn = {batch.state[0] for frame in self.frames for batch in frame["batches"]}
        shaders = drawn - set(STAGES)
        for name, text in ("plain", PLAIN), ("flat", VERTEX), ("round", ROUND):
            if any(vertex_shader(each) == name for each in drawn):
                yield from (f"shader {name}.vertex {{", text, "}")
        for name in sorted(shaders):
            yield from (f"shader {name} {{", "ps_3_0", SHADERS[name][1], "}")
        for kind in filter(self.vertices.get, self.vertices):
            extra = " texcoord1:float4 texcoord2:float1" if kind == "round" else ""
            yield f"vertices {kind} position:float2 diffuse:color texcoord:float2{extra} {{"
            yield from (" ".join(each if isinstance(each, str) else f"{each:.6g}" for each in vertex) for vertex in self.vertices[kind])
            yield "}"
            bits = 16 if len(self.vertices[kind]) <= 65536 else 32
            yield f"indices {kind}.indices {bits} {{"
            indices = self.indices[kind]
            yield from (" ".join(map(str, indices[i : i + 60])) for i in range(0, len(indices), 60))
            yield "}"
        yield "vertexconstant 0 0.001953125 -0.001953125 -1 1"
        yield "state cullmode none"
        yield "state zenable false"
        yield "state srcblend one"
        yield "state destblend invsrcalpha"
        yield "sampler 0 addressu clamp"
        yield "sampler 0 addressv clamp"
        yield "stage 0 alphaop modulate"
        for frame in self.frames:
            yield from self.calls(frame)
            yield "frame"

    def calls(self, frame):
        if frame["move"]:
            x, y, width, height, left, top = frame["move"]
            yield f"copy target part {x} {y} {width} {height} to target part {left} {top} {width} {height}"
        yield f"state scissortestenable {'true' if frame['damage'] else 'false'}"
        if frame["damage"]:
            yield "scissor " + " ".join(map(str, frame["damage"]))
        if frame["clear"]:
            yield "clear color " + frame["clear"]
        now = {}
        for batch in frame["batches"]:
            shader, texture, filters, blend = batch.state
            staged = STAGES.get(shader, {})
            wanted = {
                "bind vertices": batch.kind, "bind indices": batch.kind + ".indices",
                "vertexshader": vertex_shader(shader) + ".vertex", "pixelshader": "none" if staged else shader,
                **{f"stage 0 {name}": value for name, value in staged.items()},
                "state alphablendenable": "true" if blend else "false",
                "state shademode": "gouraud" if batch.shaded else "flat",
            }  # fmt: skip
            if self.atlas.subpixel and blend:
                wanted["state destblend"] = "invsrccolor2" if shader == "subpixel" else "invsrcalpha"
            if texture:
                filtered = "linear" if filters == "linear" else "point"
                wanted |= {
                    "bind texture": texture, "sampler 0 magfilter": filtered, "sampler 0 minfilter": filtered,
                    "sampler 0 mipfilter": "none",
                }  # fmt: skip
            yield from (f"{call} {value}" for call, value in wanted.items() if now.get(call) != value)
            now |= wanted
            yield f"draw-indexed triangles 0 {batch.first} {batch.count // 3}"
