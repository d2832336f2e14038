#!/bin/bash
# Makes sure that the Debian packages a target needs are installed, and installs those that are not.
#
#   tests/support/scripts/dependencies.sh GROUP...    groups: build test bench claims clients peers format
#                                                     fuzz browser gles d3d9 suites programs
#                                                     programs-gles conformance-gles conformance-piglit course
#                                                     slurm cross
#   tests/support/scripts/dependencies.sh --list
#
# Silent when there is nothing to do. Ends non-zero, after naming the packages and their reasons, when a
# package is missing and cannot be installed. This table is the only list of the project's dependencies.
set -euo pipefail

packages='
gcc                build   compiles the project (and the external engine, at run time)
libc6-dev          build   the C library, the mathematics library and threads
flex               build   makes the scanner of the shading language
bison              build   makes its parser
nasm               build   assembles the fragments and kernels in asm/
pkg-config         build   finds the compiler flags of the libraries below
libpng-dev         build   reads and writes PNG pictures
libopenexr-dev     build   reads and writes EXR pictures (the C core, OpenEXRCore)
libzydis-dev       build   disassembles generated code, and checks its encoding independently
libxxhash-dev      build   hashes keys, chunks and pictures
libzstd-dev        build   compresses recorded streams
libcjson-dev       build   writes and reads JSON reports
libassimp-dev      build   imports 3D models into draw streams
glmark2-data       build   the models and textures of the draw streams
assimp-testmodels  test    the animated model of a scene
python3            test    writes measured figures into the pages, and checks them
patch              test,course applies additions and planted mistakes to copies
mandoc             test    checks the manual pages
zsh                test    reads and executes its completion
fish               test    the same for its own
gdb                test,course debugs generated code: names, lines and callers of every instruction
clang              test    compiles the tests, and the rest a second time, for its warnings
cmake              test    builds and runs the example of a golden-image test
libsdl2-2.0-0      test    the window of `triptych view`, which loads it when it runs
xvfb               test,programs,programs-gles a display without a screen, for a window of `triptych view`
xdotool            test,programs presses keys in that window
valgrind           test,course,claims,clients,programs-gles counts executed instructions, for the labs of the course and the claims
hyperfine          bench   measures whole processes
gnuplot-nox        test,bench,claims draws the charts
libegl-dev         build,peers,programs the headers of EGL
libgles-dev        build,peers,programs the headers of OpenGL ES, and its libraries
libxcb-shm0-dev    build   shows pictures in windows of X11, through shared memory
libx11-xcb-dev     build   the connection of an X11 display
libegl1            test,gles,peers  finds the EGL of a vendor
khronos-api        test    the registry that the tables of OpenGL ES come from
libegl-mesa0       peers,programs-gles,conformance-gles,conformance-piglit EGL of Mesa
libgl1-mesa-dri    peers,suites,programs-gles,conformance-gles,conformance-piglit softpipe and llvmpipe of Mesa
libssl-dev         clients,claims encrypts with libcrypto, against the kernel of ChaCha20
libswscale-dev     clients,claims converts video with libswscale, against the kernel of the conversion
libavutil-dev      clients,claims the formats of libswscale
libpcre2-dev       clients,claims matches with PCRE2, against the kernel of the matcher
dpkg-dev           suites  unpacks source packages
xserver-xorg-core  suites  an X server with several display modes
xserver-xorg-video-dummy suites the driver without a screen for it
x11-xserver-utils  suites  changes the display mode
fvwm3              suites  manages the windows of Windows programs
g++-mingw-w64-x86-64 programs compiles Irrlicht for Windows
python3-pip        programs fetches the wheels of SDL, Panda3D and ANGLE
unzip              programs unpacks them
zip                programs packs the map of Irrlicht again
imagemagick        programs,programs-gles takes pictures of the screen, converts those of Irrlicht
glmark2-es2-x11    programs-gles a program of OpenGL ES with many scenes
mesa-utils-bin     programs-gles the gears of Mesa
libsdl2-tests      programs-gles the tests of SDL, one of which uses OpenGL ES
piglit             conformance-piglit tests of the OpenGL ES Shading Language
weston             programs-gles a compositor of Wayland that uses OpenGL ES
libqt5gui5-gles    programs-gles Qt with OpenGL ES instead of OpenGL
libqt5quick5-gles  programs-gles the same of Qt Quick
qmlscene           programs-gles shows a scene of Qt Quick
qml-module-qtquick2 programs-gles the shapes of Qt Quick
qml-module-qtquick-window2 programs-gles its windows
gcc-aarch64-linux-gnu cross compiles portable C for ARM64
libc6-dev-arm64-cross cross its C library
qemu-user          cross  runs programs for ARM64
libclang-rt-14-dev fuzz    libFuzzer and the sanitizers of clang, for readers of untrusted input
clang-format       format  formats the C sources
gcc-mingw-w64-x86-64 d3d9  compiles the Windows side of d3d9.dll
gcc-mingw-w64-i686 d3d9 the same for programs of 32 bits
gcc-multilib       d3d9    compiles the Unix library of 32 bits
wine               d3d9    the command that starts programs of Windows
wine64             d3d9    runs programs of Windows
wine64-tools       d3d9    marks a DLL as a builtin one of Wine
libwine-dev        d3d9    the import library of ntdll of Wine
chromium           browser opens the pages of the command explore, prints the report of the claims
slurmctld          slurm   the controller of a cluster on this machine
slurmd             slurm   its nodes
slurm-client       slurm   submits jobs, and lists them
'

describe() # PACKAGE... : their rows of the table, without the group
{
    local package group reason
    while read -r package group reason; do
        [[ " $* " == *" $package "* ]] && printf '  %-17s %s\n' "$package" "$reason"
    done <<<"$packages"
    return 0
}

stop() # REASON
{
    printf '%s\n' "dependencies: $1" >&2
    exit 1
}

if [[ ${1-} == --list ]]; then
    while read -r package group reason; do
        [[ -z $package ]] || printf '%-17s %-7s %s\n' "$package" "$group" "$reason"
    done <<<"$packages"
    exit 0
fi

wanted=()
while read -r package group reason; do
    for one in ${group//,/ }; do
        if [[ " $* " == *" $one "* ]]; then wanted+=("$package") && break; fi
    done
done <<<"$packages"

if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
    describe "${wanted[@]}" >&2
    stop 'this is no Debian (no apt-get, no dpkg-query), so the packages above cannot be installed from here'
fi

# dpkg-query fails for packages that it does not have in its list; these are not installed.
installed=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' "${wanted[@]}" 2>/dev/null |
    sed -n 's/^installed //p') || true
missing=()
for package in "${wanted[@]}"; do
    grep -qxF "$package" <<<"$installed" || missing+=("$package")
done
((${#missing[@]})) || exit 0

printf 'Installing with apt-get:\n'
describe "${missing[@]}"

administrator=(env DEBIAN_FRONTEND=noninteractive)
if ((EUID)); then
    command -v sudo >/dev/null ||
        stop 'installing needs root: run as root, or install sudo, or install the packages above yourself'
    administrator=(sudo "${administrator[@]}")
fi
# An unreachable third-party source makes the update fail. That is not an error if the installation succeeds.
"${administrator[@]}" apt-get update -qq ||
    printf '%s\n' 'dependencies: apt-get update had failures, trying with what is there' >&2
"${administrator[@]}" apt-get install -y -qq --no-install-recommends -o Dpkg::Use-Pty=0 \
    -o DPkg::Lock::Timeout=300 "${missing[@]}" ||
    stop "apt-get could not install: ${missing[*]}"
