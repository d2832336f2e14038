# Writes the draw streams of bench/streams/micro/: one kind of work each, which `make peers` measures
# Triptych's engines and other renderers on (bench/peers/workload.def names them, bench/peers/gles.c does the
# same work). Plain awk (mawk, gawk, busybox); the same text every time:
#
#     awk -v folder=bench/streams/micro -f bench/generate-micro.awk
#
# A stream has three frames, which begin with a clear. The first sets everything, so that the others can be
# played again and again on what it left (player_go_on, src/command/stream/stream.h). The second is measured,
# with enough layers that the rest of the frame does not count; the third the same work with fewer layers, for
# renderers that are slow. Textures and arithmetic have one opaque layer, and no clear but the first. The
# layers of a frame cover the whole target, 1024 x 1024, and are in the same place; by default
# each is a rectangle of two triangles at w = 1.

function emit(text) { print text > path }

function begin(name, about, bound) {
    path = folder "/" name ".tri"
    emit("triptych 1")
    emit("# " about)
    emit("# Bound by: " bound)
    emit("target 1024 1024 depth d24x8")
    emit("convention depthrange minus")
}

# The state of full-screen layers: no light, no depth, both sides.
function plain() {
    emit("state lighting false")
    emit("state cullmode none")
    emit("state zenable false")
}

function constant_color(argb) {
    emit("stage 0 colorop selectarg1")
    emit("stage 0 colorarg1 tfactor")
    emit("stage 0 alphaop selectarg1")
    emit("stage 0 alphaarg1 tfactor")
    emit("state texturefactor 0x" argb)
}

function blend(source) {
    emit("state alphablendenable true")
    emit("state srcblend " source)
    emit("state destblend invsrcalpha")
}

# The whole target, u and v from `low` to `high`, v downwards.
function quad(low, high) {
    emit("vertices quad position:float4 texcoord:float2 {")
    emit("    -1  1 0 1   " low " " low)
    emit("     1  1 0 1   " high " " low)
    emit("    -1 -1 0 1   " low " " high)
    emit("     1 -1 0 1   " high " " high)
    emit("}")
    emit("bind vertices quad")
}

# Both textures are 256 x 256: squares of 4 texels in two colours, one of them translucent; red to the right,
# green down.
function checker(mips) {
    emit("texture checker 2d A8R8G8B8 256 256 " (mips ? "mips " : "") "checker 4 ffe0a040 80203060")
}

function gradient() { emit("texture gradient 2d A8R8G8B8 256 256 gradient") }

function filter(sampler, word, mip) {
    emit("sampler " sampler " magfilter " word)
    emit("sampler " sampler " minfilter " word)
    if (mip) emit("sampler " sampler " mipfilter " mip)
}

function clamp(sampler) {
    emit("sampler " sampler " addressu clamp")
    emit("sampler " sampler " addressv clamp")
}

function one_texture() {
    checker(0)
    emit("bind texture checker")
    emit("stage 0 colorop selectarg1")
    emit("stage 0 colorarg1 texture")
    emit("stage 0 alphaop selectarg1")
    emit("stage 0 alphaarg1 texture")
}

# One sequence draws a layer; frames play it.
function layer(call) {
    emit("sequence layer")
    emit("    " call)
    emit("end")
}

function play(count, name,   i) { for (i = 0; i < count; i++) emit("play " name) }

# The frame that sets everything ends here; then `measured` begins another one, and `less` the last.
function ready(clear) { emit(clear); emit("frame") }
function measured() { emit(""); emit("# The measured frame.") }
function less() { emit(""); emit("# The same work, less of it.") }

function frames(full, short, clear) {
    if (!clear) clear = "clear color 0 0 0 1 depth 1"
    ready(clear)
    measured()
    emit(clear)
    play(full, "layer")
    emit("frame")
    less()
    emit(clear)
    play(short, "layer")
    emit("frame")
}

# An opaque layer over what is there. More of them would show nothing: a renderer may find that a layer is
# hidden by the next one, and draw only the last.
function one_layer() {
    ready("clear color 0 0 0 1 depth 1")
    measured()
    play(1, "layer")
    emit("frame")
    less()
    play(1, "layer")
    emit("frame")
}

# --- Fills ---

function fills() {
    begin("flat", "Fill: 32 opaque layers of a constant colour.",
          "stores of 4 bytes a pixel into a tile that stays in the first-level cache.")
    plain(); constant_color("ff4080c0"); quad(0, 1); layer("draw strip 0 2"); frames(32, 4)

    begin("flat-one", "Fill: a clear and one opaque layer of a constant colour a frame.",
          "stores of 4 bytes a pixel to memory, twice: colour, and what a clear of depth costs; and by how " \
              "soon all is done.")
    plain(); constant_color("ff4080c0"); quad(0, 1); layer("draw strip 0 2"); frames(1, 1)

    begin("flat-blend", "Blending: 32 layers of a constant colour, source alpha.",
          "a load and a store of 4 bytes a pixel in the first-level cache, and two products a channel.")
    plain(); constant_color("48c08040"); quad(0, 1); blend("srcalpha"); layer("draw strip 0 2"); frames(32, 4)

    begin("depth-fail", "Depth test: 32 layers, all hidden by the depths of the target.",
          "reading 4 bytes of depth a pixel, or less where whole blocks are bounded.")
    plain(); constant_color("ff4080c0"); quad(0, 1)
    emit("state zenable true")
    layer("draw strip 0 2"); frames(32, 4, "clear color 0.2 0.4 0.6 1 depth 0.25")

    begin("depth-pass", "Depth test: 32 layers, each in front of the one before.",
          "reading 4 bytes of depth and storing 8 of depth and colour a pixel, in the first-level cache.")
    plain(); constant_color("ff4080c0")
    emit("vertices quads position:float4 {")
    for (i = 0; i < 32; i++) {
        z = sprintf("%.5f", 0.9 - i * 0.03125)
        emit("    -1 1 " z " 1"); emit("    1 1 " z " 1"); emit("    -1 -1 " z " 1"); emit("    1 -1 " z " 1")
    }
    emit("}")
    emit("bind vertices quads")
    emit("state zenable true")
    emit("state zfunc less")
    ready("clear color 0 0 0 1 depth 1")
    for (i = 0; i < 2; i++) {
        if (i) less(); else measured()
        emit("clear color 0 0 0 1 depth 1")
        for (j = 0; j < (i ? 4 : 32); j++) emit("draw strip " 4 * j " 2")
        emit("frame")
    }
}

# --- Textures ---

function textures() {
    taps = " texels of 4 bytes a pixel gathered from the second-level cache, and "
    begin("nearest", "Texture: a layer of one RGBA8 texture of 256 x 256, repeated 4 times, nearest.",
          "1" taps "storing 4 bytes.")
    plain(); one_texture(); quad(0.001, 4.001); filter(0, "point"); layer("draw strip 0 2"); one_layer()

    begin("bilinear", "Texture: a layer of one RGBA8 texture of 256 x 256, repeated 4 times, bilinear.",
          "4" taps "12 linear interpolations.")
    plain(); one_texture(); quad(0.001, 4.001); filter(0, "linear"); layer("draw strip 0 2"); one_layer()

    begin("bilinear-one", "Texture: a clear and one layer of one RGBA8 texture, bilinear, a frame.",
          "4" taps "12 linear interpolations; and by how soon all is done.")
    plain(); one_texture(); quad(0.001, 4.001); filter(0, "linear"); layer("draw strip 0 2"); frames(1, 1)

    begin("bilinear-blend", "Texture: 16 bilinear layers, blended by the texture's alpha.",
          "4" taps "12 linear interpolations and 8 products, a load and a store of 4 bytes.")
    plain(); one_texture(); quad(0.001, 4.001); filter(0, "linear"); blend("srcalpha");
    layer("draw strip 0 2"); frames(16, 2)

    begin("bilinear-perspective", "Texture: a bilinear layer in perspective, w from 1 to 2.",
          "4" taps "12 linear interpolations and a division.")
    plain(); one_texture()
    emit("vertices quad position:float4 texcoord:float2 {")
    emit("    -1  1 0 1   0.001 0.001")
    emit("     2  2 0 2   4.001 0.001")
    emit("    -1 -1 0 1   0.001 4.001")
    emit("     2 -2 0 2   4.001 4.001")
    emit("}")
    emit("bind vertices quad")
    filter(0, "linear"); layer("draw strip 0 2"); one_layer()

    begin("trilinear", "Texture: a layer, repeated 11 times, bilinear in two levels of detail with linear " \
        "interpolation between them.",
          "8" taps "28 linear interpolations, and by the level of detail.")
    plain(); checker(1)
    emit("bind texture checker")
    emit("stage 0 colorop selectarg1")
    emit("stage 0 colorarg1 texture")
    emit("stage 0 alphaop selectarg1")
    emit("stage 0 alphaarg1 texture")
    quad(0.001, 11.001); filter(0, "linear", "linear"); layer("draw strip 0 2"); one_layer()

    begin("two-textures", "Texture: a layer of two bilinear textures, multiplied.",
          "8" taps "24 linear interpolations and 4 products.")
    two("quad", 0.001, 4.001, 0); one_layer()
}

function two(name, low, high, clamped,   i) {
    plain(); one_texture(); gradient()
    emit("bind texture 1 gradient")
    emit("stage 1 colorop modulate")
    emit("stage 1 colorarg1 texture")
    emit("stage 1 colorarg2 current")
    emit("stage 1 alphaop modulate")
    emit("stage 1 alphaarg1 texture")
    emit("stage 1 alphaarg2 current")
    emit("stage 1 texcoordindex 0")
    quad(low, high)
    for (i = 0; i < 2; i++) { filter(i, "linear"); if (clamped) clamp(i) }
    layer("draw strip 0 2")
}

# The usual work of a renderer of rectangles: no perspective, no repetition, textures a little magnified.
function rectangles() {
    about = "Rectangles: clamped, u and v from 0 to 0.9, "
    taps = " texels of 4 bytes a pixel, which are neighbours along a row, and by "
    begin("rectangle-blend", "Rectangles: 32 layers of a constant colour, blended, premultiplied.",
          "a load and a store of 4 bytes a pixel in the first-level cache, and one product a channel.")
    plain(); constant_color("48362412"); quad(0, 1); blend("one"); layer("draw strip 0 2"); frames(32, 4)

    begin("rectangle-nearest", about "nearest.", "loading 1" taps "storing 4 bytes.")
    plain(); one_texture(); quad(0, 0.9); filter(0, "point"); clamp(0); layer("draw strip 0 2"); one_layer()

    begin("rectangle-bilinear", about "bilinear.", "loading 4" taps "12 linear interpolations.")
    plain(); one_texture(); quad(0, 0.9); filter(0, "linear"); clamp(0); layer("draw strip 0 2"); one_layer()

    begin("rectangle-bilinear-blend", about "16 layers, bilinear, blended, premultiplied.",
          "loading 4" taps "12 linear interpolations and 4 products, a load and a store of 4 bytes.")
    plain(); one_texture(); quad(0, 0.9); filter(0, "linear"); clamp(0); blend("one");
    layer("draw strip 0 2"); frames(16, 2)

    begin("rectangle-two-textures", "Rectangles: clamped, u and v from 0 to 0.9, two bilinear textures, " \
        "multiplied.",
          "loading 8" taps "24 linear interpolations and 4 products.")
    two("quad", 0, 0.9, 1); one_layer()

    begin("rectangle-solid", "Rectangles: a constant colour.", "storing 4 bytes.")
    plain(); constant_color("ff336699"); quad(0, 1); layer("draw strip 0 2"); one_layer()

    begin("rectangle-copy", "Rectangles: a picture of 1024 x 1024 texels, one a pixel.", "loading and storing 4 bytes.")
    plain(); picture("A8R8G8B8 1024 1024 gradient", "selectarg1", "texture", "texture"); quad(0, 1); clamp(0)
    layer("draw strip 0 2"); one_layer()

    begin("rectangle-repeat", "Rectangles: a pattern of 64 x 64 texels, one a pixel, 16 times either way.",
          "loading 1 texel of 4 bytes, and storing 4 bytes.")
    plain(); picture("A8R8G8B8 64 64 gradient", "selectarg1", "texture", "texture"); quad(0, 16); layer("draw strip 0 2"); one_layer()

    begin("rectangle-modulate", "Rectangles: 16 layers of a picture times a colour, one texel a pixel, blended, " \
        "premultiplied.", "loading 4 bytes of a texel, 8 products, a load and a store of 4 bytes.")
    plain(); picture("A8R8G8B8 1024 1024 gradient", "modulate", "texture", "texture"); emit("state texturefactor 0xc0808040")
    quad(0, 1); clamp(0); blend("one"); layer("draw strip 0 2"); frames(16, 2)

    about = ", 16 layers, blended, premultiplied."
    taps = "loading 1 byte of a texel, 8 products, a load and a store of 4 bytes."
    begin("rectangle-mask", "Rectangles: a colour times a mask of one byte a pixel" about, taps)
    mask("texture_alphareplicate", "texture")
    begin("rectangle-mask-inverted", "Rectangles: a colour times 1 minus a mask of one byte a pixel" about, taps)
    mask("texture_complement_alphareplicate", "texture_complement")
}

function picture(contents, operation, colour, alpha) {
    emit("texture picture 2d " contents)
    emit("bind texture picture")
    emit("stage 0 colorop " operation)
    emit("stage 0 colorarg1 " colour)
    emit("stage 0 colorarg2 tfactor")
    emit("stage 0 alphaop " operation)
    emit("stage 0 alphaarg1 " alpha)
    emit("stage 0 alphaarg2 tfactor")
}

function mask(colour, alpha) {
    plain(); picture("A8 1024 1024 checker 24 ff000000 60000000", "modulate", colour, alpha)
    emit("state texturefactor 0xff336699"); quad(0, 1); clamp(0); blend("one"); layer("draw strip 0 2"); frames(16, 2)
}

# --- Arithmetic ---

# Two vectors, `texcoord` and `texcoord1`, from the corners to the pixels. They are in a plane, so that it
# does not matter if a renderer finds two triangles or a rectangle.
function shaded(columns,   i, n, corner) {
    plain()
    emit("shader through {")
    emit("    vs_3_0")
    emit("    dcl_position v0"); emit("    dcl_texcoord v1"); emit("    dcl_texcoord1 v2")
    emit("    dcl_position o0"); emit("    dcl_texcoord o1"); emit("    dcl_texcoord1 o2")
    emit("    mov o0, v0"); emit("    mov o1, v1"); emit("    mov o2, v2")
    emit("}")
    emit("vertices quad position:float4 texcoord:float4 texcoord1:float3 {")
    n = split(columns, corner, ";")
    for (i = 1; i <= n; i++) emit("   " corner[i])
    emit("}")
    emit("bind vertices quad")
    emit("vertexshader through")
}

function shader(text,   lines, n, i) {
    emit("shader pixels {")
    n = split(text, lines, "\n")
    for (i = 1; i <= n; i++) emit("    " lines[i])
    emit("}")
    emit("pixelshader pixels")
}

function repeated(text, count,   all) { while (count-- > 0) all = all "\n" text; return all }

# A bilinear texel and dependent multiply-adds: the more of them, the smaller the share of sampling.
function mixed(count) {
    begin("mix-" count, "Texture and arithmetic: a bilinear texel, then " count " dependent multiply-adds of four " \
              "components a pixel.",
          "4 texels gathered and 12 linear interpolations a pixel, and " 4 * count " multiply-adds of one number.")
    plain(); one_texture(); quad(0.001, 4.001); filter(0, "linear")
    shader("ps_2_x\ndcl t0.xy\ndcl_2d s0\nmov r1, c1\ntexld r0, t0, s0" repeated("mad r0, r0, c0, r1", count) \
           "\nmov oC0, r0")
    emit("pixelconstant 0 0.99 0.985 0.99 1")
    emit("pixelconstant 1 0.002 0.003 0.004 0")
    layer("draw strip 0 2"); one_layer()
}

function arithmetic() {
    corners = " -1 1 0 1  -0.6 0.7 1 1  -1 1 0; 1 1 0 1  0.8 0.5 1 1  1 1 0; -1 -1 0 1  -0.5 -0.6 1 1  -1 " \
        "-1 0;" \
              " 1 -1 0 1  0.9 -0.8 1 1  1 -1 0"
    begin("multiply-add", "Arithmetic: 64 dependent multiply-adds of four components a pixel.",
          "256 multiply-adds of one number a pixel, which wait for one another unless other pixels fill " \
              "the time.")
    shaded(" -1 1 0 1  0.1 0.9 0.3 1  0 0 0; 1 1 0 1  0.7 0.7 0.2 1  0 0 0; -1 -1 0 1  0.3 0.2 0.9 1  0 0 " \
        "0;" \
           " 1 -1 0 1  0.9 0 0.8 1  0 0 0")
    shader("ps_3_0\ndcl_texcoord v0\nmov r1, c1\nmov r0, v0" repeated("mad r0, r0, c0, r1",
        64) "\nmov oC0, r0")
    emit("pixelconstant 0 0.99 0.985 0.99 1")
    emit("pixelconstant 1 0.002 0.003 0.004 0")
    layer("draw strip 0 2"); one_layer()

    mixed(4); mixed(16); mixed(64)

    begin("normalize", "Arithmetic: 16 times n = normalize(v + (exp2 n.y, sin n.x, pow n.z)).",
          "16 times a sine, three exponentials and logarithms, a square root and a division a pixel.")
    shaded(corners)
    shader("ps_3_0\ndef c1, 1.5, 0.5, 0, 1\ndcl_texcoord v0\nmov r0, v0" \
           repeated("exp r1.x, r0.y\nsincos r1.y, r0.x\npow r1.z, r0.z, c1.x\nadd r2.xyz, r1, v0\nnrm " \
               "r0.xyz, r2", 16) \
           "\nmad r0.xyz, r0, c1.y, c1.y\nmov r0.w, c1.w\nmov oC0, r0")
    layer("draw strip 0 2"); one_layer()

    begin("phong", "Arithmetic: Phong's lighting a pixel: 3 normalisations, a reflection, power 32.",
          "about 60 multiply-adds, 3 square roots and divisions, a logarithm and an exponential a pixel.")
    shaded(corners)
    shader("ps_3_0\ndef c5, 0, 32, 0, 1\ndcl_texcoord v0\ndcl_texcoord1 v1\n" \
           "nrm r0.xyz, v0\nsub r1.xyz, c0, v1\nnrm r2.xyz, r1\nsub r3.xyz, c1, v1\nnrm r4.xyz, r3\n" \
           "dp3 r0.w, r0, r2\nadd r1.w, r0.w, r0.w\nmad r1.xyz, r0, r1.w, -r2\ndp3 r2.w, r1, r4\nmax r2.w, " \
               "r2.w, c5.x\n" \
           "pow r3.w, r2.w, c5.y\nmax r0.w, r0.w, c5.x\nmov r5, c3\nmad r5, c2, r0.w, r5\nmad oC0, c4, " \
               "r3.w, r5")
    emit("pixelconstant 0 0.5 0.8 1.5 0")
    emit("pixelconstant 1 0 0 2 0")
    emit("pixelconstant 2 0.2 0.4 0.7 0")
    emit("pixelconstant 3 0.05 0.05 0.1 1")
    emit("pixelconstant 4 0.8 0.8 0.6 0")
    layer("draw strip 0 2"); one_layer()
}

# --- Triangles ---

# Lit by a point in the vertex shader, only diffuse: position 4x4, normal 3x3 and normalised.
function lit(size, tilt, offset) {
    emit("shader lit {")
    emit("    vs_2_0"); emit("    def c10, 0, 0, 0, 0"); emit("    dcl_position v0");
    emit("    dcl_normal v1")
    emit("    add r5, v0, c11")
    emit("    m4x4 oPos, r5, c0"); emit("    m3x3 r0.xyz, v1, c4"); emit("    nrm r1.xyz, r0")
    emit("    sub r2.xyz, c7, r5"); emit("    nrm r3.xyz, r2"); emit("    dp3 r0.w, r1, r3");
    emit("    max r0.w, r0.w, c10.x")
    emit("    mov r4, c9"); emit("    mad oD0, c8, r0.w, r4")
    emit("}")
    emit("vertexshader lit")
    emit("vertexconstant 0 " size " 0 0 0  0 0 " size " 0  0 0 0.1 0.5  0 0 " tilt " 1")
    emit("vertexconstant 4 1 0 0 0  0 1 0 0  0 0 1 0")
    emit("vertexconstant 7 0.3 0.4 0.2 0")
    emit("vertexconstant 8 0.7 0.6 0.3 0")
    emit("vertexconstant 9 0.1 0.15 0.3 1")
    if (offset) emit("vertexconstant 11 0 0 0 0")
    emit("stage 0 colorop selectarg1")
    emit("stage 0 colorarg1 diffuse")
    emit("stage 0 alphaop selectarg1")
    emit("stage 0 alphaarg1 diffuse")
}

function grid(cells) { emit("mesh grid grid " cells " " cells) }

function triangles(   x, z, i) {
    begin("triangles-4", "Triangles: 199,712 of 4 pixels, indexed, lit in the vertex shader, depth test.",
          "what a vertex costs (half a one a triangle), setup, and finding a few pixels: all of it in the " \
              "caches but the records.")
    grid(316); lit(0.8728, 0.05, 1); layer("draw mesh grid"); frames(1, 1)

    begin("triangles-4-culled", "Triangles: 199,712 of 4 pixels, indexed, lit in the vertex shader, all " \
        "with their back to the camera.",
          "the cost of a vertex (half of one a triangle) and the test of a triangle's direction.")
    grid(316); lit(0.8728, 0.05, 1)
    emit("state cullmode cw")
    layer("draw mesh grid"); frames(1, 1)

    begin("triangles-4-separate", "Triangles: 199,680 of 4 pixels, each with vertices of its own, lit in " \
        "the vertex shader, depth test, " \
          "in 260 draws of 768.",
          "what three vertices cost, setup, and finding a few pixels.")
    emit("vertices cells position:float3 normal:float3 {")
    for (z = 0; z < 24; z++)
        for (x = 0; x < 16; x++) {
            emit("    " x " 0 " z " 0 1 0"); emit("    " x " 0 " z + 1 " 0 1 0");
            emit("    " x + 1 " 0 " z + 1 " 0 1 0")
            emit("    " x " 0 " z " 0 1 0"); emit("    " x + 1 " 0 " z + 1 " 0 1 0");
            emit("    " x + 1 " 0 " z " 0 1 0")
        }
    emit("}")
    emit("bind vertices cells")
    lit(0.8728, 0.05, 0)
    # In cells here: 320 x 312 of them.
    emit("vertexconstant 0 0.005455 0 0 0  0 0 0.005594872 0  0 0 0.000641026 0.5  0 0 0.000320513 1")
    emit("vertexconstant 7 48 64 32 0")
    emit("sequence layer")
    for (z = -156; z < 156; z += 24)
        for (x = -160; x < 160; x += 16) {
            emit("    vertexconstant 11 " x " 0 " z " 0")
            emit("    draw triangles 0 768")
        }
    emit("end")
    frames(1, 1)

    begin("triangles-64", "Triangles: 16,200 of 64 pixels, indexed, lit in the vertex shader, depth test.",
          "setup, finding pixels, and 8 bytes of colour and depth a pixel.")
    grid(90); lit(0.985, 0.004, 1); layer("draw mesh grid"); frames(1, 1)
}

# --- Draws ---

# 10,000 triangles of 8 pixels, 100 in each of 100 rows.
function draws(name, about, colors,   i) {
    begin(name, about, "what a draw costs besides its pixels.")
    emit("state cullmode none")
    emit("state zenable false")
    emit("shader place {")
    emit("    vs_2_0"); emit("    dcl_position v0"); emit("    add r0, v0, c4"); emit("    add oPos, r0, c5")
    emit("}")
    emit("shader color {")
    emit("    ps_2_0"); emit("    mov oC0, c0")
    emit("}")
    emit("vertices small position:float3 {")
    emit("    -0.0035 0.0035 0"); emit("    0.0045 0.0035 0"); emit("    -0.0035 -0.0045 0")
    emit("}")
    emit("bind vertices small")
    emit("vertexshader place")
    emit("pixelshader color")
    emit("pixelconstant 0 1 1 1 1")
    emit("sequence row")
    for (i = 0; i < 100; i++) {
        emit("    vertexconstant 4 " sprintf("%.7g", (i * 10 + 12 - 512) / 512) " 0 0 0")
        if (colors) emit("    pixelconstant 0 " sprintf("%.2f %.2f %.2f", i / 99, 1 - i / 99,
            (i % 10) / 9) " 1")
        emit("    draw triangles 0 1")
    }
    emit("end")
    emit("sequence layer")
    for (i = 0; i < 100; i++) {
        emit("    vertexconstant 5 0 " sprintf("%.7g", (i * 10 + 12 - 512) / 512) " 0 0")
        emit("    play row")
    }
    emit("end")
    frames(1, 1)
}

# --- The rest ---

function rest() {
    begin("clear", "A clear of colour and depth, and nothing else.",
        "stores of 8 bytes a pixel to memory, unless they are put off.")
    emit("sequence layer")
    emit("end")
    frames(1, 1, "clear color 0.2 0.4 0.6 1 depth 1")

    begin("readback", "One layer, whose pixels are then read: only the reading is measured.",
          "copying 4 bytes a pixel through memory.")
    plain(); one_texture(); quad(0, 0.9); filter(0, "linear"); clamp(0); layer("draw strip 0 2"); frames(1, 1)

    begin("new-shader", "A small rectangle with a pixel shader, which is replaced before every measured " \
        "frame: " \
          "the numbers of its def are new. From the text to the first pixel.",
          "the compiler.")
    plain()
    emit("shader pixels {")
    emit("    ps_2_0"); emit("    def c0, 0.25, 0.5, 0.75, 1"); emit("    dcl t0.xy"); emit("    dcl_2d s0")
    emit("    texld r0, t0, s0"); emit("    mul r1.xyz, r0, c0"); emit("    dp3 r0.w, r1, r1");
    emit("    mad r1.xyz, r0, r0.w, c0.w")
    emit("    mov r1.w, c0.w"); emit("    mul r1.xyz, r1, c0.y"); emit("    mov oC0, r1")
    emit("}")
    checker(0)
    emit("bind texture checker")
    filter(0, "linear")
    emit("pixelshader pixels")
    emit("vertices quad position:float4 texcoord:float2 {")
    emit("    -0.01 0.01 0 1   0.1 0.1"); emit("    0.01 0.01 0 1   0.2 0.1")
    emit("    -0.01 -0.01 0 1   0.1 0.2"); emit("    0.01 -0.01 0 1   0.2 0.2")
    emit("}")
    emit("bind vertices quad")
    layer("draw strip 0 2"); frames(1, 1)
}

BEGIN {
    if (!folder) { print "usage: awk -v folder=DIR -f generate-micro.awk" > "/dev/stderr"; exit 2 }
    fills(); textures(); rectangles(); arithmetic(); triangles()
    draws("draws", "Draws: 10,000 of one triangle of 8 pixels, two changed constants before each.", 1)
    draws("draws-one", "Draws: 10,000 of one triangle of 8 pixels, one changed constant before each.", 0)
    rest()
}
