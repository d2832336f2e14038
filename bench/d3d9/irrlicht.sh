#!/bin/bash
# Builds the engine Irrlicht of Debian's source package for Windows, its examples and irrlicht.cpp.
#
#   bench/d3d9/irrlicht.sh FOLDER    FOLDER/irrlicht/: *.exe, and media/
#
# Debian's package has none of the libraries that Irrlicht would unpack JPEG, PNG and compressed archives
# with. The pictures are converted to BMP (with alpha: TGA) under their own names, and the map's archive is
# packed again without compression: Irrlicht finds a picture's format from its contents.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$1/irrlicht"
out=$(cd "$1/irrlicht" && pwd)

unpack()
{
    mkdir -p "$out/source"
    tar -xf "$("$here/source.sh" irrlicht "$1/packages")" -C "$out/source" --strip-components=1 \
        --wildcards '*/source/Irrlicht/*' '*/include/*' '*/media/*' '*/examples/*/main.cpp'
}

picture() # FILE : converts it in its place
{
    local kind=bmp3
    [[ $(identify -format '%[channels]' "$1") != *a* ]] || kind=tga
    convert "$1" -type "$([[ $kind == tga ]] && echo TrueColorAlpha || echo TrueColor)" "$kind:$1.new"
    mv "$1.new" "$1"
}

media()
{
    rm -rf "$out/media"
    cp -r "$out/source/media" "$out/media"
    mkdir "$out/media/map"
    unzip -q "$out/media/map-20kdm2.pk3" -d "$out/media/map"
    find "$out/media" -regex '.*\.\(jpg\|png\)' | while read -r file; do picture "$file"; done
    rm "$out/media/map-20kdm2.pk3"
    (cd "$out/media/map" && zip -q -0 -r ../map-20kdm2.pk3 .)
    rm -r "$out/media/map"
}

without=(OPENGL_ DIRECT3D_8_ DIRECTINPUT_JOYSTICK_ JOYSTICK_EVENTS_ LIBJPEG_ LIBPNG_ ZLIB_ BZIP2_ LZMA_
    ZIP_ENCRYPTION_ SOFTWARE_ BURNINGSVIDEO_ CONSOLE_DEVICE_)
flags=(-O2 -w -fpermissive -std=gnu++98 -D_IRR_STATIC_LIB_ -DNDEBUG -DIRR_COMPILE_WITH_DX9_DEV_PACK "-I$out/source/include"
    "-I$out/source/source/Irrlicht")
for name in "${without[@]}"; do flags+=("-DNO_IRR_COMPILE_WITH_$name"); done
libraries=(-static -lgdi32 -luser32 -lole32 -lwinmm -luuid -ldxguid -limm32 -lcomctl32 -ladvapi32 -lversion)

library()
{
    mkdir -p "$out/object"
    # Sources that the configuration excludes compile to empty objects.
    (cd "$out/source/source/Irrlicht" && ls ./*.cpp) | sed 's|^\./||; s|\.cpp$||' |
        xargs -P "$(nproc)" -I '{}' x86_64-w64-mingw32-g++ "${flags[@]}" -c "$out/source/source/Irrlicht/{}.cpp" \
            -o "$out/object/{}.o"
    rm -f "$out/libIrrlicht.a"
    x86_64-w64-mingw32-ar rcs "$out/libIrrlicht.a" "$out"/object/*.o
}

program() # SOURCE NAME
{
    x86_64-w64-mingw32-g++ "${flags[@]}" "$1" -o "$out/$2.exe" "$out/libIrrlicht.a" "${libraries[@]}"
}

[[ -d $out/source/source ]] || unpack "$1"
[[ -f $out/media/map-20kdm2.pk3 && ! -d $out/media/map ]] || media
[[ -f $out/libIrrlicht.a ]] || library
program "$here/programs/irrlicht.cpp" irrlicht
