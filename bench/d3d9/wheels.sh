#!/bin/bash
# Fetches Windows builds of SDL, ANGLE and Panda3D from the Python package index, and builds the programs that
# use them.
#
#   bench/d3d9/wheels.sh FOLDER    FOLDER/sdl/, FOLDER/gles/ and FOLDER/panda/ with their programs
#
# Needs python3 with pip, unzip, x86_64-w64-mingw32-gcc, the headers of GLES2 and EGL, and those of SDL from
# Debian's source package.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$1"
out=$(cd "$1" && pwd)
compile=(x86_64-w64-mingw32-gcc -std=gnu17 -O2 -Wall -Wextra -Werror)

fetch()
{
    python3 -m pip --disable-pip-version-check download --quiet --no-deps --dest "$out/wheels" --platform win_amd64 \
        --python-version 3.11 --only-binary=:all: pysdl2-dll==2.32.10 panda3d==1.10.16 kivy-deps.angle==0.5.0
}

sdl()
{
    mkdir -p "$out/sdl/include"
    unzip -qoj -d "$out/sdl" "$out"/wheels/pysdl2_dll-*.whl '*/SDL2.dll'
    tar -xf "$("$here/source.sh" libsdl2 "$out/packages")" -C "$out/sdl/include" --strip-components=2 --wildcards \
        '*/include/*.h'
    "${compile[@]}" -I"$out/sdl/include" "$here/programs/sdl.c" "$out/sdl/SDL2.dll" -o "$out/sdl/sdl.exe" -lm
}

# The headers are copied, because a folder of the system's own headers confuses the compiler for Windows.
gles()
{
    mkdir -p "$out/gles/include"
    unzip -qoj -d "$out/gles" "$out"/wheels/kivy_deps_angle-*.whl '*.dll'
    cp -rL /usr/include/GLES2 /usr/include/EGL /usr/include/KHR "$out/gles/include/"
    "${compile[@]}" -I"$out/gles/include" "$here/programs/gles.c" "$out"/gles/lib{EGL,GLESv2}.dll \
        -o "$out/gles/gles.exe" -lgdi32
}

panda()
{
    [[ -d $out/panda/panda3d ]] || unzip -qo -d "$out/panda" "$out"/wheels/panda3d-*.whl
    mkdir -p "$out/panda/configuration"
    cat >"$out/panda/configuration/programs.prc" <<PRC
load-display pandadx9
aux-display pandadx9
load-file-type egg pandaegg
model-path Z:$out/panda/panda3d/models
plugin-path Z:$out/panda/panda3d
win-size 800 600
win-origin 0 0
audio-library-name null
sync-video #f
model-cache-dir
PRC
}

[[ $(find "$out/wheels" -name '*.whl' 2>/dev/null | wc -l) -ge 3 ]] || fetch
sdl
gles
panda
