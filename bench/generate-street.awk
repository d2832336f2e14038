# Writes bench/streams/street.tri: a street at dusk, some four hundred objects in about a hundred states, and
# a camera that moves down it for sixty frames. Plain awk (mawk, gawk, busybox); the same text every time:
#
#     awk -f bench/generate-street.awk > bench/streams/street.tri
#
# The street runs toward -z between x = -3.5 and 3.5, with pavements to 6.4 and houses beyond; y is up, a
# unit is a metre. Objects set the whole state they need and emit() writes what differs from the state before,
# as an engine with a state cache does; states without effect (filters without a texture, factors without
# blending) keep their value. Translucent objects are collected and drawn last, from far to near.

function random() { seed = (seed * 16807) % 2147483647; return seed / 2147483647 }
function between(low, high) { return low + (high - low) * random() }
function number(v) { v = sprintf("%.2f", v); sub(/\.?0+$/, "", v); return v == "-0" ? "0" : v }
function triple(x, y, z) { return number(x) " " number(y) " " number(z) }
function call(text) { print "    " text }

# --- State ---

function want(   i) {
    for (i = 1; i <= state_count; i++) wanted[state_name[i]] = state_default[i]
    texture = "none"; world = "identity"; lights = ""; material = ""; mesh = ""
}

function relevant(name) {
    if (name ~ /^(srcblend|destblend)$/) return wanted["alphablendenable"] == "true"
    if (table[name] != "state") return texture != "none"
    if (name ~ /^(ambient|normalizenormals)$/) return wanted["lighting"] == "true"
    if (name ~ /^(zfunc|zwriteenable)$/) return wanted["zenable"] == "true"
    return 1
}

function emit_lights(   i, on) {
    for (i = 0; i < 8; i++) {
        on = index(lights, i) > 0
        if (on != light_is[i]) call("light " i (on ? " on" : " off"))
        light_is[i] = on
    }
}

function emit_state(   i, name) {
    for (i = 1; i <= state_count; i++) {
        name = state_name[i]
        if (!relevant(name) || wanted[name] == state_is[name]) continue
        call(table[name] " " name " " wanted[name])
        state_is[name] = wanted[name]
    }
    if (wanted["lighting"] == "true") {
        emit_lights()
        if (material != material_is) call("material " material)
        material_is = material
    }
    if (texture != texture_is) call("bind texture " texture)
    texture_is = texture
    if (world != world_is) call("transform world " world)
    world_is = world
}

# Draws the current object: a mesh from a file, or one of the shapes defined here with its indices or as a
# fan or strip.
function emit(   part) {
    emit_state()
    objects++
    split(shape[mesh], part, " ")
    if (part[1] == "mesh") {
        call("draw mesh " mesh)
        vertices_is = indices_is = mesh
        return
    }
    if (vertices_is != mesh) call("bind vertices " mesh)
    vertices_is = mesh
    if (part[1] != "indexed") {
        call("draw " part[1] " 0 " part[2])
        return
    }
    if (indices_is != mesh) call("bind indices " mesh "-faces")
    indices_is = mesh
    call("draw-indexed triangles 0 0 " part[2])
}

# Keeps the current object until after the opaque ones; z is its position.
function later(z,   i, all) {
    all = texture "|" world "|" lights "|" material "|" mesh
    for (i = 1; i <= state_count; i++) all = all "|" wanted[state_name[i]]
    for (i = late_count++; i > 0 && late_z[i - 1] > z; i--) { late_z[i] = late_z[i - 1];
        late[i] = late[i - 1] }
    late_z[i] = z; late[i] = all
}

function emit_late(   i, k, part) {
    for (i = 0; i < late_count; i++) {
        split(late[i], part, "|")
        texture = part[1]; world = part[2]; lights = part[3]; material = part[4]; mesh = part[5]
        for (k = 1; k <= state_count; k++) wanted[state_name[k]] = part[5 + k]
        emit()
    }
    late_count = 0
}

function set(name, value) { wanted[name] = value }
function at(operations) { world = operations }
function paint(name, filter, operation) { texture = name; set("magfilter", filter); set("minfilter", filter);
    set("colorop", operation); set("alphaop", operation) }
function clamp() { set("addressu", "clamp"); set("addressv", "clamp") }
function unlit() { set("lighting", "false") }
# The target's alpha stays 1: what has an alpha of its own does not write it.
function keep_alpha() { set("colorwriteenable", 7) }
function translucent(source, destination) {
    set("alphablendenable", "true"); set("srcblend", source); set("destblend", destination)
    set("zwriteenable", "false"); keep_alpha()
}
function surface(r, g, b, a) { material = "diffuse " triple(r, g, b) " " number(a) " ambient " triple(r, g,
    b) " 1" }

# Sun and sky, and the lamps that reach a circle about (x, z), at most `most` of them.
function lit(x, z, reach, most,   i, d) {
    lights = "01"
    for (i = 0; i < lamps && most > 0; i++) {
        d = sqrt((x - lamp_x[i]) ^ 2 + (z - lamp_z[i]) ^ 2)
        if (d < reach) { lights = lights (i + 2); most-- }
    }
}

# --- Shapes ---

function begin_shape(name, attributes) { print "vertices " name " " attributes " {"; corner = 0; faces = "";
    triangles = 0 }
function end_shape(name) {
    print "}"
    if (triangles) print "indices " name "-faces 16 {" faces "\n}"
    shape[name] = "indexed " triangles
}
function face(a, b, c) { faces = faces (triangles++ % 8 ? "  " : "\n    ") a " " b " " c }
function four(a, b, c, d) { face(a, b, c); face(a, c, d) }

# A grid of columns x rows cells from o along u and v, facing n, with texture coordinates 0 to s, t (t
# downward).
function grid(ox, oy, oz, ux, uy, uz, vx, vy, vz, nx, ny, nz, columns, rows, s, t,   i, j, a, b, first) {
    first = corner
    for (j = 0; j <= rows; j++)
        for (i = 0; i <= columns; i++) {
            a = i / columns; b = j / rows
            print "    " triple(ox + a * ux + b * vx, oy + a * uy + b * vy, oz + a * uz + b * vz) "  " \
                  triple(nx, ny, nz) "  " number(a * s) " " number((1 - b) * t)
            corner++
        }
    for (j = 0; j < rows; j++)
        for (i = 0; i < columns; i++) {
            a = first + j * (columns + 1) + i; b = a + columns + 1
            four(a, a + 1, b + 1, b)
        }
}

# A side of a solid that runs around the y axis: `sides` faces from radius r0 at y0 to r1 at y1, smooth
# normals.
function around(y0, r0, y1, r1, sides,   i, c, s, k, l, normal, first) {
    first = corner; k = (r0 - r1) / (y1 - y0); l = sqrt(1 + k * k)
    for (i = 0; i <= sides; i++) {
        c = cos(2 * pi * i / sides); s = sin(2 * pi * i / sides)
        normal = "  " triple(c / l, k / l, -s / l)
        print "    " triple(r0 * c, y0, -r0 * s) normal
        print "    " triple(r1 * c, y1, -r1 * s) normal
        corner += 2
        if (i < sides) four(first + 2 * i, first + 2 * i + 2, first + 2 * i + 3, first + 2 * i + 1)
    }
}

# A triangle of a position-and-normal list, with its own normal.
function facet(ax, ay, az, bx, by, bz, cx, cy, cz,   nx, ny, nz, l) {
    nx = (by - ay) * (cz - az) - (bz - az) * (cy - ay)
    ny = (bz - az) * (cx - ax) - (bx - ax) * (cz - az)
    nz = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    l = sqrt(nx * nx + ny * ny + nz * nz)
    print "    " triple(ax, ay, az) "  " triple(nx / l, ny / l, nz / l)
    print "    " triple(bx, by, bz) "  " triple(nx / l, ny / l, nz / l)
    print "    " triple(cx, cy, cz) "  " triple(nx / l, ny / l, nz / l)
    triangles++
}

function solid_shapes() {
    begin_shape("box", "position:float3 normal:float3 texcoord:float2")
    grid(-1, -1, 1, 2, 0, 0, 0, 2, 0, 0, 0, 1, 1, 1, 1, 1)
    grid(1, -1, 1, 0, 0, -2, 0, 2, 0, 1, 0, 0, 1, 1, 1, 1)
    grid(1, -1, -1, -2, 0, 0, 0, 2, 0, 0, 0, -1, 1, 1, 1, 1)
    grid(-1, -1, -1, 0, 0, 2, 0, 2, 0, -1, 0, 0, 1, 1, 1, 1)
    grid(-1, 1, 1, 2, 0, 0, 0, 0, -2, 0, 1, 0, 1, 1, 1, 1)
    end_shape("box")
    begin_shape("wall", "position:float3 normal:float3 texcoord:float2")
    grid(1, 0, 1, 0, 0, -2, 0, 1, 0, 1, 0, 0, 6, 4, 5, 4)
    grid(-1, 0, 1, 2, 0, 0, 0, 1, 0, 0, 0, 1, 4, 3, 5, 4)
    grid(1, 0, -1, -2, 0, 0, 0, 1, 0, 0, 0, -1, 4, 3, 5, 4)
    end_shape("wall")
    begin_shape("slopes", "position:float3 normal:float3 texcoord:float2")
    grid(1.15, -0.1, 1.08, 0, 0, -2.16, -1.15, 1.1, 0, 0.69, 0.72, 0, 4, 2, 6, 4)
    grid(-1.15, -0.1, -1.08, 0, 0, 2.16, 1.15, 1.1, 0, -0.69, 0.72, 0, 4, 2, 6, 4)
    end_shape("slopes")
    begin_shape("gable", "position:float3 normal:float3 texcoord:float2")
    print "    -1 0 1  0 0 1  0 1\n    1 0 1  0 0 1  5 1\n    0 0.95 1  0 0 1  2.5 0"
    print "    1 0 -1  0 0 -1  0 1\n    -1 0 -1  0 0 -1  5 1\n    0 0.95 -1  0 0 -1  2.5 0"
    end_shape("gable"); shape["gable"] = "triangles 2"
    begin_shape("post", "position:float3 normal:float3")
    around(0, 0.13, 0.5, 0.13, 8); around(0.5, 0.08, 4.6, 0.05, 8)
    end_shape("post")
    begin_shape("trunk", "position:float3 normal:float3")
    around(0, 0.3, 0.4, 0.2, 10); around(0.4, 0.2, 2.6, 0.14, 10)
    end_shape("trunk")
    begin_shape("wheel", "position:float3 normal:float3")
    around(0, 0.33, 0.2, 0.33, 14); around(0.2, 0.33, 0.21, 0.2, 14); around(0.19, 0.2, 0.2, 0.001, 14)
    end_shape("wheel")
}

function ground_shapes() {
    begin_shape("road", "position:float3 normal:float3 texcoord:float2")
    grid(-0.5, 0, 0.5, 1, 0, 0, 0, 0, -1, 0, 1, 0, 6, 6, 3, 4)
    end_shape("road")
    begin_shape("pavement-slab", "position:float3 normal:float3 texcoord:float2")
    grid(-0.5, 0, 0.5, 1, 0, 0, 0, 0, -1, 0, 1, 0, 3, 6, 2, 6)
    end_shape("pavement-slab")
    begin_shape("meadow", "position:float3 normal:float3 texcoord:float2")
    grid(-0.5, 0, 0.5, 1, 0, 0, 0, 0, -1, 0, 1, 0, 2, 2, 30, 40)
    end_shape("meadow")
    print "vertices patch position:float3 texcoord:float2 {"
    print "    -0.5 0 0.5  0 1\n    0.5 0 0.5  1 1\n    0.5 0 -0.5  1 0\n    -0.5 0 -0.5  0 0\n}"
    shape["patch"] = "fan 2"
    print "vertices dash position:float3 diffuse:float4 {"
    print "    -0.5 0 0.5  0.9 0.88 0.8 0.5\n    0.5 0 0.5  0.9 0.88 0.8 0.5"
    print "    0.5 0 -0.5  0.95 0.95 0.9 0.85\n    -0.5 0 -0.5  0.95 0.95 0.9 0.85\n}"
    shape["dash"] = "fan 2"
}

# Upright squares: `panel` faces +x, `card` faces +z.
function flat_shapes(   i) {
    begin_shape("panel", "position:float3 normal:float3 texcoord:float2")
    grid(0, -0.5, 0.5, 0, 0, -1, 0, 1, 0, 1, 0, 0, 1, 1, 1, 1)
    end_shape("panel")
    print "vertices interior position:float3 diffuse:color {"
    print "    0 -0.5 0.5  ffb06828\n    0 -0.5 -0.5  ffd08030\n    0 0.5 -0.5  fff8c870\n    0 0.5 0.5  " \
        "ffe8b058\n}"
    shape["interior"] = "fan 2"
    print "vertices dark-interior position:float3 diffuse:float3 {"
    print "    0 -0.5 0.5  0.05 0.06 0.1\n    0 -0.5 -0.5  0.06 0.07 0.1"
    print "    0 0.5 -0.5  0.2 0.22 0.3\n    0 0.5 0.5  0.16 0.18 0.26\n}"
    shape["dark-interior"] = "fan 2"
    print "vertices card position:float2 texcoord:float2 {"
    print "    -0.5 -0.5  0 1\n    0.5 -0.5  1 1\n    -0.5 0.5  0 0\n    0.5 0.5  1 0\n}"
    shape["card"] = "strip 2"
    print "vertices cloud position:float2 texcoord:float2 diffuse:float4 {"
    print "    -0.5 -0.5  0 1  0.95 0.62 0.5 0\n    0.5 -0.5  1 1  0.95 0.66 0.5 0"
    print "    -0.5 0.5  0 0  0.62 0.5 0.6 0\n    0.5 0.5  1 0  0.62 0.5 0.6 0\n}"
    shape["cloud"] = "strip 2"
    print "vertices palings position:float4 texcoord:float3 {"
    print "    0 0 0.5 1  0 1 0\n    0 0 -0.5 1  8 1 0\n    0 1 0.5 1  0 0 0\n    0 1 -0.5 1  8 0 0\n}"
    shape["palings"] = "strip 2"
    print "vertices sky position:float4 diffuse:float3 {"
    print "    -420 -40 -400 1  0.98 0.63 0.38\n    420 -40 -400 1  0.98 0.63 0.38"
    print "    -420 12 -400 1  0.97 0.6 0.37\n    420 12 -400 1  0.97 0.6 0.37"
    print "    -420 75 -400 1  0.58 0.43 0.5\n    420 75 -400 1  0.58 0.43 0.5"
    print "    -420 330 -400 1  0.13 0.18 0.36\n    420 330 -400 1  0.13 0.18 0.36\n}"
    shape["sky"] = "strip 6"
    print "vertices disc position:float2 {\n    0 0"
    for (i = 0; i <= 20; i++) print "    " number(cos(pi * i / 10)) " " number(sin(pi * i / 10))
    print "}"
    shape["disc"] = "fan 20"
}

# A car from its outline, front toward -z; the cabin leans inward. Then its windows.
function car_shapes(   n, z, y, x, i, k, j, s) {
    n = split("-2.1 -2.12 -1.95 -1.05 -0.45 0.85 1.5 2.02 2.1 2.1", z, " ")
    split("0.3 0.68 0.82 0.94 1.4 1.43 1 0.92 0.7 0.3", y, " ")
    for (i = 1; i <= n; i++) x[i] = y[i] > 1.2 ? 0.64 : 0.86
    begin_shape("car", "position:float3 normal:float3")
    for (i = 1; i < n; i++) {
        k = i + 1
        facet(x[i], y[i], z[i], -x[k], y[k], z[k], x[k], y[k], z[k])
        facet(x[i], y[i], z[i], -x[i], y[i], z[i], -x[k], y[k], z[k])
    }
    for (i = 1; i <= n; i++) {
        k = i % n + 1
        facet(0.9, 0.62, 0, x[i], y[i], z[i], x[k], y[k], z[k])
        facet(-0.9, 0.62, 0, -x[k], y[k], z[k], -x[i], y[i], z[i])
    }
    i = triangles; triangles = 0; end_shape("car"); shape["car"] = "triangles " i
    print "vertices car-glass position:float3 diffuse:color {"
    for (s = -1; s <= 1; s += 2) {
        print "    " triple(s * 0.87, 0.98, -0.85) "  c0303848\n    " triple(s * 0.67, 1.36,
            -0.4) "  c0607088"
        print "    " triple(s * 0.87, 0.98, 0.15) "  c0303848\n    " triple(s * 0.67, 1.36, 0.15) "  c0607088"
        print "    " triple(s * 0.87, 0.98, 0.25) "  c0303848\n    " triple(s * 0.67, 1.36, 0.25) "  c0607088"
        print "    " triple(s * 0.87, 0.98, 1.3) "  c0303848\n    " triple(s * 0.67, 1.36, 0.8) "  c0607088"
    }
    print "    -0.7 1.02 -1  c0405068\n    0.7 1.02 -1  c0405068\n    -0.58 1.38 -0.53  c08090a8\n    0.58 " \
        "1.38 -0.53  c08090a8"
    print "    -0.7 1.05 1.47  c0303848\n    0.7 1.05 1.47  c0303848\n    -0.58 1.4 0.93  c0687890\n    " \
        "0.58 1.4 0.93  c0687890\n}"
    print "indices car-glass-faces 16 {\n    0 1 2  2 1 3  4 5 6  6 5 7  8 9 10  10 9 11  12 13 14  14 13 15"
    print "    16 17 18  18 17 19  20 21 22  22 21 23\n}"
    shape["car-glass"] = "indexed 12"
}

function screen_shapes() {
    print "vertices plate position:float2 diffuse:color {"
    print "    -0.98 0.62  90101828\n    -0.98 0.96  90283850\n    -0.5 0.62  60101828\n    -0.5 0.96  " \
        "60283850\n}"
    shape["plate"] = "strip 2"
    print "vertices gauge position:float2 texcoord:float1 {"
    print "    -0.94 0.66  0\n    -0.94 0.69  0\n    -0.56 0.66  1\n    -0.56 0.69  1\n}"
    shape["gauge"] = "strip 2"
    print "vertices veil position:float3 diffuse:float4 {"
    print "    -420 -300 -398  0.9 0.6 0.45 0.02\n    420 -300 -398  0.9 0.6 0.45 0.02"
    print "    -420 330 -398  0.9 0.55 0.45 0.2\n    420 330 -398  0.9 0.55 0.45 0.2\n}"
    shape["veil"] = "strip 2"
}

# --- Objects ---

function ground(   i, z, s) {
    want(); mesh = "meadow"; paint("grass", "linear", "modulate"); surface(0.9, 0.9, 0.9, 1); lights = "01"
    at("scale 240 1 220 translate 0 -0.12 -80"); emit()
    for (i = 0; i < 12; i++) {
        z = 8 - 8 * i
        want(); mesh = "road"; paint("asphalt", i < 7 ? "linear" : "point", "modulate"); surface(1, 1, 1, 1)
        lit(0, z - 4, 10, 3); at("scale 7 1 8 translate 0 0 " number(z - 4)); emit()
        for (s = -1; s <= 1; s += 2) {
            want(); mesh = "pavement-slab"; paint("pavement", i < 7 ? "linear" : "point", "modulate");
            surface(1, 1, 1, 1)
            lit(s * 5, z - 4, 9, 3); at("scale 3 1 8 translate " triple(s * 5, 0.12, z - 4)); emit()
            if (i < 9) {
                want(); mesh = "box"; surface(0.6, 0.6, 0.58, 1); lit(s * 3.5, z - 4, 8, 1);
                set("shademode", "flat")
                set("normalizenormals", "true")
                at("scale 0.08 0.07 4 translate " triple(s * 3.5, 0.06, z - 4)); emit()
            }
        }
    }
}

function marks(   i) {
    for (i = 0; i < 16; i++) {
        want(); unlit(); mesh = "dash"; translucent("srcalpha", "invsrcalpha");
        if (i % 4 == 1) set("shademode", "flat")
        at("scale 0.15 1 2.2 translate 0 0.012 " number(5 - 5 * i)); later(-1000 + i)
    }
}

function wall_style(i) {
    if (i % 5 == 0) { paint("brick", "linear", "modulate"); surface(1, 0.98, 0.94, 1) }
    if (i % 5 == 1) { paint("plaster", "linear", "modulate"); surface(0.98, 0.86, 0.62, 1) }
    if (i % 5 == 2) { surface(0.62, 0.72, 0.78, 1) }
    if (i % 5 == 3) { paint("brick", "point", "modulate"); surface(0.8, 0.78, 0.9, 1) }
    if (i % 5 == 4) { paint("plaster", "point", "modulate"); surface(0.75, 0.9, 0.72, 1) }
}

function place(s, x, y, z, scale) { return "scale " scale (s > 0 ? " rotate 180 0 1 0" : "") " " \
    "translate " triple(x, y, z) }

# One window: the room beyond it, then the frame with translucent panes; or, cheaper, one opaque picture of
# both.
function window(i, s, x, y, z, style) {
    want(); if (style == 0) { unlit(); mesh = "panel"; paint("window", "linear", "selectarg1"); clamp();
        keep_alpha() }
    if (style == 1) { unlit(); mesh = "interior" }
    if (style == 2) { unlit(); mesh = "dark-interior"; set("zfunc", "less") }
    if (style == 3) { mesh = "panel"; paint("window", "point", "add"); clamp(); keep_alpha();
        surface(0.3, 0.22, 0.1, 1); lights = "0" }
    at(place(s, x, y, z, "1 1.3 1.2")); emit()
    if (style != 1 && style != 2) return
    want(); unlit(); mesh = "panel"; paint("window", i % 2 ? "linear" : "point", "selectarg1"); clamp()
    translucent("srcalpha", "invsrcalpha"); if (i % 3 == 0) set("zfunc", "less")
    if (i % 4 == 1) { set("lighting", "true"); set("colorop", "modulate"); set("alphaop", "modulate");
        surface(1, 1, 1, 1); lit(x, z, 9, 2) }
    at(place(s, x - s * 0.01, y, z, "1 1.3 1.2")); later(z)
}

function house(i, s, z,   x, d, l, h, front, floor, k) {
    d = 3.4; l = 3.8; h = i * 7 % 3; h = h ? 4.4 + 0.8 * h : 3.1; front = s * 6.5; x = s * (6.5 + d)
    want(); mesh = "wall"; wall_style(i); lit(front, z, 11, 3); set("normalizenormals", "true")
    if (i % 7 == 2) set("shademode", "flat")
    at(place(s, x, 0, z, triple(d, h, l))); emit()
    if (i % 6 == 3) {
        # A second pass of light where the first pass is visible.
        translucent("one", "invsrcalpha"); set("zfunc", "equal"); surface(0.4, 0.3, 0.2, 0);
        set("ambient", "0xff000000")
        lights = substr(lights, 3); if (lights == "") lights = "0"
        texture = "none"; emit()
    }
    want(); mesh = "gable"; wall_style(i); lit(x, z, 9, 1); set("normalizenormals", "true")
    at(place(s, x, h, z, triple(d, 2.5, l))); emit()
    want(); mesh = "slopes"; set("normalizenormals", "true"); lit(x, z, 8, 2); set("cullmode", "none")
    if (i % 3 != 2) paint("roof", i % 2 ? "linear" : "point", "modulate")
    if (i % 4 == 1) set("shademode", "flat")
    surface(0.8 - (i % 3) * 0.12, 0.8 - (i % 2) * 0.15, 0.85, 1)
    at(place(s, x, h, z, triple(d, 2.5, l))); emit()
    want(); mesh = "box"; paint("brick", "point", "modulate"); surface(0.9, 0.85, 0.8, 1); lights = "01"
    set("normalizenormals", "true"); set("addressv", "clamp")
    at("scale 0.35 0.9 0.35 translate " triple(x + s * 1.1, h + 2.3, z + (i % 2 ? 2 : -2))); emit()
    want(); mesh = "panel"; paint("door", i % 3 ? "linear" : "point", "modulate"); clamp();
    set("normalizenormals", "true")
    surface(0.8 + 0.2 * (i % 2), 1 - 0.2 * (i % 3), 0.9, 1); lit(front, z, 9, i % 3)
    at(place(s, front - s * 0.02, 1.15, z, "1 2.1 1.05")); emit()
    want(); mesh = "box"; surface(0.55, 0.55, 0.52, 1); lit(front, z, 7, 1); set("shademode", "flat");
    set("normalizenormals", "true")
    at("scale 0.3 0.06 0.7 translate " triple(front - s * 0.3, 0.16, z)); emit()
    for (floor = 0; floor < (h > 4 ? 2 : 1); floor++)
        for (k = -1; k <= 1; k += 2)
            window(i + floor + (k > 0), s, front - s * 0.02, 1.7 + 2.5 * floor, z + k * 2.2,
                (i * 5 + floor * 3 + (k > 0) * 2) % 4)
}

# The shadow that an object of this size leaves on the ground.
function blob(x, y, z, w, l) {
    want(); unlit(); mesh = "patch"; paint("shadow", "linear", "selectarg1"); clamp();
    translucent("srcalpha", "invsrcalpha")
    at("scale " triple(w, 1, l) " translate " triple(x, y, z)); later(z - 500)
}

function tree(i, x, z, size,   crown) {
    want(); mesh = "trunk"; surface(0.34, 0.24, 0.17, 1); lit(x, z, 9, 2);
    if (i % 2) set("normalizenormals", "true")
    at("scale " triple(size, size, size) " translate " triple(x, 0, z)); emit()
    crown = "scale " triple(1.5 * size, 1.7 * size, 1.5 * size) " rotate " i * 47 " 0 1 0 " \
        "translate " triple(x, 3.4 * size, z)
    want(); at(crown); surface(0.30 + 0.05 * (i % 3), 0.44 + 0.04 * (i % 2), 0.20, 1); lit(x, z, 10, i % 4)
    set("normalizenormals", "true")
    mesh = i % 3 == 0 ? "leaves" : "rock"
    if (mesh == "leaves") { paint("grass", i % 2 ? "linear" : "point", "modulate"); surface(1, 1, 0.8, 1) }
    if (i % 4 == 2) {
        # Depth first, colour where it is equal: each pixel of the crown is shaded once.
        unlit(); set("colorwriteenable", 0); texture = "none"; emit()
        set("lighting", "true"); set("colorwriteenable", 15); set("zfunc", "equal");
        set("zwriteenable", "false")
        if (mesh == "leaves") texture = "grass"
    }
    if (i % 5 == 1) set("shademode", "flat")
    emit()
    blob(x, 0.14, z, 3 * size, 3 * size)
}

function garden(i, s, z,   k) {
    for (k = 0; k < 2; k++) tree(i + k, s * (8.3 + 3 * k + random()), z - 1.7 + 3.2 * k, between(0.8, 1.15))
    for (k = -1; k <= 1; k++) {
        want(); mesh = "rock"; surface(0.22, 0.36, 0.16, 1); lit(s * 7, z, 8, k + 1);
        set("normalizenormals", "true")
        if (k == 0) set("shademode", "flat")
        at("scale 0.75 0.6 0.85 rotate " i * 60 + k * 100 " 0 1 0 translate " triple(s * 7.6, 0.4,
            z + 2.3 * k)); emit()
    }
    want(); unlit(); mesh = "palings"; paint("fence", i % 2 ? "linear" : "point", "selectarg1");
    set("addressv", "clamp")
    set("cullmode", "none"); translucent("srcalpha", "invsrcalpha"); if (i % 3) set("zwriteenable", "true")
    at("scale 1 1 8 translate " triple(s * 6.5, 0.1, z)); later(z)
}

function lamp(i, x, z,   s) {
    s = x > 0 ? 1 : -1
    want(); mesh = "post"; surface(0.14, 0.16, 0.17, 1); lit(x, z, 4, 1);
    if (i % 2) set("normalizenormals", "true")
    at("translate " triple(x, 0.12, z)); emit()
    want(); mesh = "box"; surface(0.14, 0.16, 0.17, 1); lights = "01";
    set("shademode", i % 2 ? "flat" : "gouraud")
    set("normalizenormals", "true")
    at("scale 0.5 0.04 0.04 translate " triple(x - s * 0.45, 4.68, z)); emit()
    want(); mesh = "box"; material = "diffuse 0 0 0 1 emissive 1 0.86 0.55 1";
    set("cullmode", i % 2 ? "cw" : "none")
    at("scale 0.3 0.08 0.14 translate " triple(x - s * 0.9, 4.58, z)); emit()
    want(); unlit(); mesh = "card"; paint("glow", "linear", "selectarg1"); clamp();
    translucent("one", "invsrcalpha")
    at("scale 2.6 2.6 1 translate " triple(x - s * 0.9, 4.55, z + 0.2)); later(z + 0.2)
    want(); unlit(); mesh = "patch"; paint("glow", "linear", "selectarg1"); clamp();
    translucent("one", "invsrcalpha")
    if (i % 2) set("colorwriteenable", 3)
    at("scale 5 1 5 translate " triple(x - s * 2.7, 0.02, z)); later(z - 400)
}

function car(i, x, z, turn, r, g, b,   k, base, wheel) {
    base = " rotate " turn " 0 1 0 translate " triple(x, 0, z)
    want(); mesh = "car"; surface(r, g, b, 1); lit(x, z, 10, 3); if (i % 2) set("shademode", "flat")
    if (i % 3 == 0) set("normalizenormals", "true")
    at("identity" base); emit()
    for (k = 0; k < 4; k++) {
        want(); mesh = "wheel"; surface(0.12, 0.12, 0.13, 1); lit(x, z, 6, k % 2)
        wheel = "rotate " (k % 2 ? -90 : 90) " 0 0 1 translate " triple(k % 2 ? 0.7 : -0.7, 0.33,
            k < 2 ? -1.35 : 1.35)
        at(wheel base); emit()
    }
    want(); unlit(); mesh = "car-glass"; set("cullmode", "none"); translucent("srcalpha", "invsrcalpha")
    set("zwriteenable", i % 2 ? "true" : "false"); if (i % 3 == 1) set("zfunc", "less")
    at("identity" base); later(z)
    blob(x, 0.02, z, 3.2, 6)
}

function stand(name, x, y, z, turn, size) {
    mesh = name; lit(x, z, 9, 3); set("normalizenormals", "true")
    at("rotate " (name == "teapot" ? -90 : 90) " 1 0 0 rotate " turn " 0 1 0 scale " triple(size, size,
        size) " translate " triple(x, y, z))
}

function beast(name, x, y, z, turn, size, r, g, b, style) {
    want(); surface(r, g, b, 1); stand(name, x, y, z, turn, size); set("shademode", style); emit()
}

# The same, faintly, where another object hides it.
function behind(name, x, y, z, turn, size) {
    want(); surface(0.4, 0.65, 1, 0.4); stand(name, x, y, z, turn, size); lights = "01"
    translucent("srcalpha", "invsrcalpha"); set("zfunc", "greater"); later(z)
}

function things(   i) {
    for (i = 0; i < 7; i++) {
        want(); mesh = "box"; paint("crate", i % 3 ? "linear" : "point",
            i % 4 == 3 ? "selectarg1" : "modulate"); surface(1, 1, 1, 1)
        lit(5.6, -11, 8, i % 3 + 1); set("normalizenormals", i % 2 ? "true" : "false"); if (i % 2) clamp()
        if (wanted["colorop"] == "selectarg1") unlit()
        at("scale 0.45 0.45 0.45 rotate " i * 23 " 0 1 0 translate " triple(5.5 + 0.1 * (i % 3),
            0.57 + 0.9 * (i > 4), -9.4 - (i % 5) * 1.15)); emit()
        if (i < 5) blob(5.5 + 0.1 * (i % 3), 0.14, -9.4 - i * 1.15, 1.6, 1.6)
    }
    want(); mesh = "box"; paint("marble", "linear", "modulate"); surface(1, 1, 1, 1); lit(-5.2, -17.5, 9, 2)
    set("normalizenormals", "true"); at("scale 0.75 0.5 1 translate -5.2 0.6 -17.5"); emit()
    want(); mesh = "box"; paint("marble", "point", "modulate"); surface(0.9, 0.9, 1, 1); lit(5.2, -33, 9, 2)
    set("normalizenormals", "true"); at("scale 0.75 0.5 1 translate 5.2 0.6 -33"); emit()
    beast("horse", -5.2, 1.95, -17.5, 60, 1, 0.50, 0.42, 0.30, "gouraud")
    beast("horse", 5.2, 1.95, -33, -60, 1, 0.36, 0.46, 0.42, "flat")
    beast("cat", 4.6, 0.52, -4.2, -60, 0.62, 0.86, 0.58, 0.30, "gouraud")
    beast("cat", -4.4, 0.52, -24, 50, 0.6, 0.30, 0.30, 0.32, "flat")
    beast("cat", 8.4, 0.52, -28.5, 20, 0.62, 0.9, 0.88, 0.84, "gouraud");
    behind("cat", 8.4, 0.52, -28.5, 20, 0.62)
    blob(4.6, 0.14, -4.2, 1.4, 1.4); blob(-4.4, 0.14, -24, 1.4, 1.4)

    # A tea shop: the sign is a teapot, the awning is seen from both sides.
    want(); surface(1, 1, 1, 1); paint("porcelain", "linear", "modulate"); set("cullmode", "none")
    stand("teapot", -5.4, 3.75, -12.1, 90, 0.7); emit()
    for (i = 0; i < 6; i++) {
        want(); unlit(); mesh = "patch"; set("cullmode", "none");
        if (i % 2) paint("porcelain", "point", "selectarg1")
        at("scale 1.5 1 0.66 rotate -18 0 0 1 translate " triple(-5.8, 2.8, -12.1 + 0.66 * (i - 2.5))); emit()
    }

    # A poster printed for red and cyan glasses: one picture, twice, each in its channels.
    for (i = 0; i < 2; i++) {
        want(); unlit(); mesh = "panel"; paint("picture", "linear", "selectarg1"); clamp()
        set("colorwriteenable", i ? 6 : 1); set("zfunc", i ? "lessequal" : "less")
        at("scale 1 1.5 2 rotate 180 0 1 0 translate " triple(6.46 - 0.01 * i, 4.2, -12.1 + 0.05 * i)); emit()
    }
    # Three neon discs, each in one channel.
    for (i = 0; i < 3; i++) {
        want(); unlit(); mesh = "disc"; set("cullmode", "none");
        set("colorwriteenable", i == 0 ? 1 : i == 1 ? 2 : 4)
        set("zwriteenable", "false")
        at("scale 0.4 0.4 0.4 rotate 90 0 1 0 translate " triple(-6.46 + 0.01 * i, 2.1 + (i == 0) * 0.4,
            -28.4 + (i == 1) * 0.45 + (i == 0) * 0.22)); emit()
    }
}

# Drawn where nothing is nearer than the far end of the depth range; the veil where something is.
function sky(   i) {
    call("viewport 0 0 1280 1024 1 1")
    want(); unlit(); mesh = "sky"; set("cullmode", "none"); set("zwriteenable", "false"); emit()
    want(); unlit(); mesh = "card"; paint("glow", "linear", "selectarg1"); clamp();
    translucent("one", "invsrcalpha"); set("zfunc", "equal")
    at("scale 210 210 1 translate -22 14 -390"); emit()
    for (i = 0; i < 7; i++) {
        want(); unlit(); mesh = "cloud"; paint("shadow", "linear", "add"); clamp();
        translucent("srcalpha", "invsrcalpha"); set("zfunc", "equal")
        at("scale " triple(between(70, 150), between(9, 18), 1) " translate " triple(-190 + 62 * i,
            70 + 75 * random(), -390)); emit()
    }
    want(); unlit(); mesh = "veil"; translucent("srcalpha", "invsrcalpha"); set("zfunc", "notequal"); emit()
    call("viewport 0 0 1280 1024 0 1")
}

# The screen's corner: a plate, a gauge, and a teapot in a viewport whose depth runs the other way.
function screen() {
    call("transform view identity"); call("transform projection identity")
    want(); unlit(); mesh = "plate"; set("zenable", "false"); set("cullmode", "none");
    translucent("srcalpha", "invsrcalpha"); emit()
    want(); unlit(); mesh = "gauge"; set("zenable", "false"); set("cullmode", "none");
    paint("scale", "point", "selectarg1"); clamp(); emit()
    call("transform projection perspective-rh 30 1.5 1 10"); call("viewport 40 40 240 130 1 0")
    call("clear depth 0")
    want(); mesh = "teapot"; surface(0.95, 0.8, 0.4, 1); material = material " emissive 0.15 0.12 0.06 1";
    lights = "1"; set("zfunc", "greaterequal"); set("cullmode", "none")
    set("normalizenormals", "true"); at("rotate -90 1 0 0 rotate 35 0 1 0 rotate 20 1 0 0 translate 0 " \
        "-0.05 -3.6"); emit()
    call("viewport 0 0 1280 1024 0 1")
}

# Coordinates of the camera have two decimals.
function rounded(sum) { return " (round(100 * " (sum ~ / / ? "(" sum ")" : sum) ") / 100)" }

function animate() {
    print "repeat 60"
    call("let t = frame / (count - 1)")
    call("let x = 1.1 + 1.5 * sin(6 * t)")
    call("let y = 2.1 + 2.2 * t * t * (3 - 2 * t)")
    call("let z = 9.5 - 40 * t")
    call("transform projection perspective-rh 52 1.25 0.2 600")
    call("transform view lookat-rh" rounded("x") rounded("y") rounded("z") " " \
        rounded("x * 0.3 - 0.9 + 1.5 * sin(4 * t)") rounded("2.5 - 0.9 * t") rounded("z - 16") "  0 1 0")
    call("clear color 0 0 0 1 depth 1")
    call("play street")
    call("frame")
    print "end"
}

function prologue(   i) {
    print "triptych 1"
    print "# A street at dusk, written by bench/generate-street.awk, which explains it.\n"
    print "target 1280 1024"
    for (i = 1; i <= split("asphalt brick door fence glow grass marble pavement plaster porcelain roof " \
        "shadow window", texture_file, " "); i++)
        print "texture " texture_file[i] " file \"assets/" texture_file[i] ".png\""
    print "texture crate file \"../../build/glmark2/textures/crate-base.png\""
    print "texture picture file \"../../build/glmark2/textures/effect-2d.png\""
    print "texture scale 5 1 { ff40c060 ff90c840 ffe0c030 ffe08030 ffe04030 }"
    print "mesh horse file \"../../build/glmark2/models/horse.3ds\" center fit 2"
    print "mesh cat file \"../../build/glmark2/models/cat.3ds\" center fit 2"
    print "mesh rock file \"../../build/glmark2/models/asteroid-low.3ds\" center fit 2"
    print "mesh leaves file \"../../build/glmark2/models/asteroid-low.3ds\" texcoords spherical center fit 2"
    print "mesh teapot bezier \"assets/teapot.bez\" subdivisions 6 center fit 2"
    shape["horse"] = shape["cat"] = shape["rock"] = shape["leaves"] = shape["teapot"] = "mesh"
    solid_shapes(); ground_shapes(); flat_shapes(); car_shapes(); screen_shapes()
    print "light 0 directional diffuse 0.85 0.52 0.30 1 direction 0.35 -0.30 0.85"
    print "light 1 directional diffuse 0.26 0.30 0.42 1 direction -0.25 -0.55 -0.75"
    for (i = 0; i < lamps; i++)
        print "light " (i + 2) " point diffuse 1 0.72 0.38 1 position " triple(lamp_x[i] * 0.82, 4.4,
            lamp_z[i]) " range 16 attenuation 0.35 0.06 0.045"
}

BEGIN {
    seed = 2007; pi = atan2(0, -1); lamps = 6
    for (i = 0; i < lamps; i++) { lamp_x[i] = i % 2 ? 4.4 : -4.4; lamp_z[i] = -1 - 12 * i }
    state_count = split("cullmode shademode lighting normalizenormals ambient zenable zwriteenable zfunc " \
        "alphablendenable srcblend destblend colorwriteenable colorop alphaop magfilter minfilter addressu " \
        "addressv", state_name, " ")
    split("cw gouraud true false 0xff62667c true true lessequal false one zero 15 modulate selectarg1 " \
        "linear linear wrap wrap", state_default, " ")
    for (i = 1; i <= state_count; i++) table[state_name[i]] = i <= 12 ? "state" : i <= 14 ? "stage " \
        "0" : "sampler 0"
    prologue()
    print "sequence street"
    for (i = 0; i < 8; i++) { call("light " i " off"); light_is[i] = 0 }
    ground()
    for (i = 0; i < 11; i++) {
        if (i % 4 == 2) garden(i, -1, -3.5 - 8.6 * i); else house(i, -1, -3.5 - 8.6 * i)
        if (i % 4 == 0) garden(i + 1, 1, -3.5 - 8.6 * i); else house(i + 4, 1, -3.5 - 8.6 * i)
    }
    marks()
    for (i = 0; i < lamps; i++) lamp(i, lamp_x[i], lamp_z[i])
    car(0, -2.6, 0.5, 0, 0.65, 0.12, 0.10); car(1, 2.6, -8, 0, 0.16, 0.30, 0.55);
    car(2, -2.6, -20, 180, 0.75, 0.72, 0.66)
    car(3, 2.6, -26, 0, 0.20, 0.42, 0.26); car(4, -2.6, -38, 180, 0.70, 0.55, 0.15);
    car(5, 2.6, -44, 2, 0.3, 0.3, 0.34)
    car(6, -1.6, -58, 180, 0.8, 0.8, 0.82)
    for (i = 0; i < 6; i++) tree(i, i % 2 ? 5.7 : -5.7, -1.5 - 13 * i, 0.75)
    things()
    sky()
    emit_late()
    screen()
    print "end"
    animate()
}
