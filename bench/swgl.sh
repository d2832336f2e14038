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
for part in peer workload; do
    clang -std=gnu17 -O2 -Isrc -c "bench/peers/$part.c" -o "$folder/$part.o"
done
clang++ "$folder"/{swgl,peer,workload}.o -pthread -o "$folder/renderer"
printf 'hello\n' | "$folder/renderer" span
