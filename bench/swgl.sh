#!/bin/bash
# Builds Mozilla's swgl into a renderer for `make peers`: the crates swgl and glsl-to-cxx (MPL 2.0) from
# crates.io, which translate GLSL to C++ when they are built, and bench/peers/swgl.cc. Needs cargo and
# clang++.
#
#   bench/swgl.sh [FOLDER]    build/swgl
set -euo pipefail
cd "$(dirname "$0")/.."

folder=${1:-build/swgl}
version=0.70.0
for tool in cargo clang clang++; do
    command -v "$tool" >/dev/null || { echo "swgl: no $tool" >&2 && exit 1; }
done
mkdir -p "$folder/src" "$folder/shaders"

cat >"$folder/Cargo.toml" <<TOML
[package]
name = "translate"
version = "0.0.0"
edition = "2021"
[workspace]
[dependencies]
glsl-to-cxx = "=$version"
[build-dependencies]
[features]
sources = ["dep:swgl"]
[dependencies.swgl]
version = "=$version"
optional = true
TOML
cat >"$folder/src/main.rs" <<'RUST'
fn main() {
    print!("{}", glsl_to_cxx::translate(&mut std::env::args()));
}
RUST
cargo build --quiet --release --manifest-path "$folder/Cargo.toml"
cargo fetch --quiet --manifest-path "$folder/Cargo.toml"
sources=$(cargo metadata --format-version 1 --features sources --manifest-path "$folder/Cargo.toml" |
    grep -o "\"manifest_path\":\"[^\"]*/swgl-$version/Cargo.toml\"" | head -n 1 | cut -d'"' -f4)
sources=${sources%/Cargo.toml}/src
[[ -f $sources/gl.cc ]] || { echo "swgl: no sources of swgl $version" >&2 && exit 1; }

# The shaders of bench/peers/gles_shader.c, as far as swgl takes part, in the GLSL that it translates; its
# powers below 2^-126 are none.
shaders=()
shader() # NAME VERTEX PIXEL
{
    local file=$folder/shaders/$1
    printf '%s\n' "$2" >"$file.vert"
    printf 'out vec4 color;\n%s\n' "$3" >"$file.frag"
    "$folder/target/release/translate" "$file.vert" "$file.frag" >"$file.h"
    shaders+=("$1")
}

pass='in vec4 position; in vec2 texcoord; out vec2 uv;
void main(void) { gl_Position = position; uv = texcoord; }'
vectors='in vec4 position; in vec4 first; in vec4 second; out vec4 a; out vec4 b;
void main(void) { gl_Position = position; a = first; b = second; }'
flat='uniform vec4 constant;
void main(void) { color = constant; }'
texture='in vec2 uv; uniform sampler2D checker;
void main(void) { color = texture(checker, uv); }'
multiply_add=$(for _ in {1..64}; do printf 'r = r * factor + term; '; done)

shader flat 'in vec4 position; void main(void) { gl_Position = position; }' "$flat"
shader flat_span 'in vec4 position; void main(void) { gl_Position = position; }' "$flat
void swgl_drawSpanRGBA8() { swgl_commitSolidRGBA8(constant); }"
shader tex "$pass" "$texture"
shader tex_span "$pass" "$texture
void swgl_drawSpanRGBA8() { swgl_commitTextureRGBA8(checker, uv, vec4(0.0, 0.0, 1.0, 1.0)); }"
product='in vec2 uv; uniform sampler2D checker; uniform vec4 constant;'
shader modulate "$pass" "$product
void main(void) { color = texture(checker, uv) * constant; }"
shader modulate_span "$pass" "$product
void main(void) { color = texture(checker, uv) * constant; }
void swgl_drawSpanRGBA8() { swgl_commitTextureColorRGBA8(checker, uv, vec4(0.0, 0.0, 1.0, 1.0), constant); }"
shader repeat "$pass" "$product
void main(void) { color = texture(checker, fract(uv)); }"
shader repeat_span "$pass" "$product
void main(void) { color = texture(checker, fract(uv)); }
void swgl_drawSpanRGBA8() {
    swgl_commitTextureRepeatRGBA8(checker, uv, vec2(0.0), vec4(0.0, 0.0, 1.0, 1.0), vec4(0.0, 0.0, 1.0, 1.0));
}"
# A mask is a clip mask of the rectangle, which weights a span of one colour. swgl inverts a mask only in a
# target of bytes, which is then the clip mask.
shader mask "$pass" "$product
void main(void) { color = constant * texture(checker, uv).r; }"
shader mask_span 'in vec4 position; uniform sampler2D checker;
void main(void) { gl_Position = position; swgl_clipMask(checker, vec2(0.0), vec2(0.0), vec2(1024.0)); }' "$flat
void swgl_drawSpanRGBA8() { swgl_commitSolidRGBA8(constant); }"
shader inverse "$pass" "$product
void main(void) { color = constant * (1.0 - texture(checker, uv).r); }"
shader invert_span "$pass" "$product
void main(void) { color = vec4(1.0 - texture(checker, uv).r); }
void swgl_drawSpanR8() {
    swgl_commitPartialTextureLinearInvertR8(swgl_SpanLength, checker, uv, vec4(0.0, 0.0, 1.0, 1.0));
}"
shader two "$pass" 'in vec2 uv; uniform sampler2D checker; uniform sampler2D gradient;
void main(void) { color = texture(checker, uv) * texture(gradient, uv); }'
shader mads "$vectors" "in vec4 a; uniform vec4 factor; uniform vec4 term;
void main(void) { vec4 r = a; $multiply_add color = r; }"
shader phong "$vectors" 'in vec4 a; in vec4 b;
uniform vec4 light; uniform vec4 eye; uniform vec4 diffuse; uniform vec4 ambient; uniform vec4 specular;
void main(void) {
    vec3 n = a.xyz; n = n * inversesqrt(dot(n, n));
    vec3 l = light.xyz - b.xyz; l = l * inversesqrt(dot(l, l));
    vec3 v = eye.xyz - b.xyz; v = v * inversesqrt(dot(v, v));
    float d = dot(n, l);
    vec3 r = n * (2.0 * d) - l;
    float s = pow(max(dot(r, v), 0.1), 32.0);
    color = specular * s + (diffuse * max(d, 0.0) + ambient);
}'

# The pages (bench/pages/page.py). Values of a whole rectangle are flat: its colour, unless the
# rectangle is shaded, and the shape of its corners.
place='gl_Position = vec4(position * vec2(0.001953125, -0.001953125) + vec2(-1.0, 1.0), 0.0, 1.0);'
plain="in vec2 position; in vec4 paint; flat out vec4 ink;
void main(void) { $place ink = swgl_forceScalar(paint); }"
sampled="in vec2 position; in vec4 paint; in vec2 texcoord; flat out vec4 ink; out vec2 uv;
void main(void) { $place ink = swgl_forceScalar(paint); uv = texcoord; }"
shaded="in vec2 position; in vec4 paint; in vec2 texcoord; out vec4 ink; out vec2 uv;
void main(void) { $place ink = paint; uv = texcoord; }"
subpixel="in vec2 position; in vec4 paint; in vec2 texcoord; out vec2 uv;
void main(void) { $place swgl_blendSubpixelText(swgl_forceScalar(paint)); uv = texcoord; }"
corners="in vec2 position; in vec4 paint; in vec2 texcoord; in vec4 place; in float radius;
flat out vec4 ink; out vec2 uv; out vec2 at; flat out vec2 inner; flat out float edge;
void main(void) { $place ink = swgl_forceScalar(paint); uv = texcoord; at = place.xy;
    inner = swgl_forceScalar(place.zw); edge = swgl_forceScalar(radius); }"
shaded_corners=${corners/flat out vec4 ink/out vec4 ink}
shaded_corners=${shaded_corners/swgl_forceScalar(paint)/paint}
ink='flat in vec4 ink; in vec2 uv; uniform sampler2D texels;'
round='in vec2 at; flat in vec2 inner; flat in float edge;
float coverage(vec2 from) { return clamp(edge - length(max(abs(from) - inner, vec2(0.0))), 0.0, 1.0); }'
whole='vec4(0.0, 0.0, 1.0, 1.0)'
white='ink.r + ink.g + ink.b + ink.a > 3.999'

page() # NAME VERTEX PIXEL SPAN : a program without the span path, and one with it
{
    shader "page_$1" "$2" "$3"
    shader "page_$1_span" "$2" "$3
$4"
}

page solid "$plain" 'flat in vec4 ink;
void main(void) { color = ink; }' 'void swgl_drawSpanRGBA8() { swgl_commitSolidRGBA8(ink); }'
# A gradient's colours are two rows of a table, which swgl interpolates in steps of integers.
page solid_shaded "$shaded" 'in vec4 ink; in vec2 uv; uniform sampler2D stops; uniform vec4 gradient;
void main(void) { color = ink; }' 'void swgl_drawSpanRGBA8() {
    int address = swgl_validateGradient(stops, ivec2(0, int(gradient.x)), 3);
    if (address < 0) return;
    swgl_commitLinearGradientRGBA8(stops, address, 1.0, false, false, uv, gradient.yz, 0.0);
}'
page image "$sampled" "$ink
void main(void) { color = texture(texels, uv) * ink; }" "void swgl_drawSpanRGBA8() {
    if ($white) swgl_commitTextureRGBA8(texels, uv, $whole);
    else swgl_commitTextureColorRGBA8(texels, uv, $whole, ink);
}"
page mask "$sampled" "$ink
void main(void) { color = ink * texture(texels, uv).r; }" \
    "void swgl_drawSpanRGBA8() { swgl_commitTextureLinearColorR8ToRGBA8(texels, uv, $whole, ink); }"
# The vertex shader has replaced the blending by that of a mask of three stripes.
page subpixel "$subpixel" "in vec2 uv; uniform sampler2D texels;
void main(void) { color = texture(texels, uv); }" \
    "void swgl_drawSpanRGBA8() { swgl_commitTextureRGBA8(texels, uv, $whole); }"
shader page_line "$sampled" "$ink
void main(void) { color = ink * clamp(uv.y - abs(uv.x), 0.0, 1.0); }"
# Between the corners of a row, a rectangle has its colour; pixels at its corners are drawn in groups of four.
page rounded "$corners" "flat in vec4 ink; $round
void main(void) { color = ink * coverage(at); }" 'void swgl_drawSpanRGBA8() {
    float x = swgl_forceScalar(at.x);
    float y = max(abs(swgl_forceScalar(at.y)) - inner.y, 0.0);
    float reach = (edge - 1.0) * (edge - 1.0) - y * y;
    vec2 from = at;
    if (reach >= 0.0) {
        reach = inner.x + sqrt(reach);
        int before = (max(int(ceil(-reach - x)), 0) + 3) / 4;
        while (before > 0 && swgl_SpanLength > 0) {
            before -= 1;
            swgl_commitColorRGBA8(ink * coverage(from));
            from += swgl_interpStep(at);
        }
        int between = (int(floor(reach - swgl_forceScalar(from.x))) + 1) / 4;
        if (between > 0 && swgl_SpanLength > 0) {
            swgl_commitPartialSolidRGBA8(between * 4, ink);
            from += swgl_interpStep(at) * float(between);
        }
    }
    while (swgl_SpanLength > 0) {
        swgl_commitColorRGBA8(ink * coverage(from));
        from += swgl_interpStep(at);
    }
}'
shader page_rounded_shaded "$shaded_corners" "in vec4 ink; $round
void main(void) { color = ink * coverage(at); }"
# Rows between the corners are a picture.
page rounded_image "$corners" "$ink $round
void main(void) { color = texture(texels, uv) * ink * coverage(at); }" "void swgl_drawSpanRGBA8() {
    float x = swgl_forceScalar(at.x);
    float last = x + swgl_forceScalar(swgl_interpStep(at).x) * 0.25 * float(swgl_SpanLength - 1);
    if (abs(swgl_forceScalar(at.y)) > inner.y || max(abs(x), abs(last)) > inner.x + edge - 1.0) return;
    if ($white) swgl_commitTextureRGBA8(texels, uv, $whole);
    else swgl_commitTextureColorRGBA8(texels, uv, $whole, ink);
}"

{
    printf '#include "%s.h"\n' "${shaders[@]}"
    echo 'ProgramLoader load_shader(const char* name) {'
    for name in "${shaders[@]}"; do echo "  if (!strcmp(name, \"$name\")) return ${name}_program::loader;"; \
        done
    echo '  return nullptr;'
    echo '}'
} >"$folder/shaders/load_shader.h"

# The flags of swgl's own build.
clang++ -std=c++20 -O2 -DNDEBUG -fno-exceptions -fno-rtti -fno-math-errno -ffast-math -mrecip=none \
    -fno-finite-math-only -w -I"$sources" -I"$folder/shaders" -Ibench/peers -c bench/peers/swgl.cc -o \
        "$folder/swgl.o"
for part in peer workload gles_texel; do
    clang -std=gnu17 -O2 -Isrc -c "bench/peers/$part.c" -o "$folder/$part.o"
done
clang -std=gnu17 -O2 -c bench/peers/gles/page.c -o "$folder/page.o"
clang++ "$folder"/{swgl,peer,workload,gles_texel,page}.o -pthread -o "$folder/renderer"
printf 'hello\n' | "$folder/renderer" span
