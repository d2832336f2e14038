#!/bin/bash
# Fetches the Mesa of a newer Debian into a folder, for `make peers` and `make programs-gles`, which then also
# measure this llvmpipe. The folder has Mesa, LLVM and all libraries that they need. Nothing is installed on
# the system, and no root is needed: apt-get downloads into the folder, and dpkg-deb unpacks there.
#
#   bench/mesa.sh [FOLDER]    build/mesa
#
# In the environment:
#   SUITE=name     the release of Debian. Default: trixie
#   MIRROR=address its archive. Default: that of this system's first source
#
# FOLDER/run PROGRAM [ARGUMENT]... starts a program of this system with Mesa, the loader and the C library of
# the folder; libraries that it does not have are this system's. FOLDER/version has the versions of Mesa and
# of LLVM.
# Ends with 2 if the system is not a Debian, and with 1 if the packages cannot be fetched.
set -euo pipefail
cd "$(dirname "$0")/.."

folder=${1:-build/mesa}
suite=${SUITE:-trixie}
packages=(libegl-mesa0 libgl1-mesa-dri libegl1 libgles1 libgles2 libgl1 libglx-mesa0 libx11-6 libx11-xcb1 libxcb-shm0)
keyring=/usr/share/keyrings/debian-archive-keyring.gpg
for tool in apt-get dpkg-deb; do
    command -v "$tool" >/dev/null || { echo "mesa: no $tool, expected a Debian" >&2 && exit 2; }
done
[[ -s $keyring ]] || { echo "mesa: no $keyring, expected the package debian-archive-keyring" >&2 && exit 2; }
mirror=${MIRROR:-$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Label: Debian' | head -n 1)}
mkdir -p "$folder"
folder=$(realpath "$folder")
state=$folder/apt
mkdir -p "$state"/{lists,cache/archives}/partial "$folder/root"
: >"$state/status"
echo "deb [signed-by=$keyring] ${mirror:-http://deb.debian.org/debian} $suite main" >"$state/sources.list"

get()
{
    apt-get -qq -o Dir::State="$state" -o Dir::State::status="$state/status" -o Dir::State::lists="$state/lists" \
        -o Dir::Cache="$state/cache" -o Dir::Etc::sourcelist="$state/sources.list" -o Dir::Etc::sourceparts=/dev/null \
        -o Dir::Etc::preferences=/dev/null -o Dir::Etc::preferencesparts=/dev/null -o APT::Sandbox::User= \
        -o APT::Install-Recommends=false "$@"
}
get update || { echo "mesa: no lists of $suite from $mirror" >&2 && exit 1; }
get install --download-only --yes "${packages[@]}" >/dev/null ||
    { echo "mesa: $suite has not all of ${packages[*]}" >&2 && exit 1; }
rm -rf "$folder/root"
mkdir "$folder/root"
for archive in "$state"/cache/archives/*.deb; do
    dpkg-deb --extract "$archive" "$folder/root"
done

libraries=$folder/root/usr/lib/x86_64-linux-gnu
for needed in "$libraries/libEGL_mesa.so.0" "$folder/root/usr/lib64/ld-linux-x86-64.so.2"; do
    [[ -e $needed ]] || { echo "mesa: the packages have no $needed" >&2 && exit 1; }
done
version() { dpkg-deb --field "$(printf '%s\n' "$state"/cache/archives/$1_*.deb | tail -n 1)" Version; }
llvm=$(basename "$(printf '%s\n' "$state"/cache/archives/libllvm*.deb | tail -n 1)")
llvm=${llvm#libllvm}
echo "Mesa $(version libgl1-mesa-dri), LLVM ${llvm%%[_t]*}" >"$folder/version"
cat >"$folder/run" <<RUN
#!/bin/sh
# Starts a program with the libraries of bench/mesa.sh. Programs that it starts get this system's.
program=\$(command -v "\$1") || { echo "run: \$1: not found" >&2 && exit 127; }
shift
export LIBGL_DRIVERS_PATH='$libraries/dri' GBM_BACKENDS_PATH='$libraries/gbm'
export __EGL_VENDOR_LIBRARY_FILENAMES='$folder/root/usr/share/glvnd/egl_vendor.d/50_mesa.json'
exec '$folder/root/usr/lib64/ld-linux-x86-64.so.2' --argv0 "\$program" \\
    --library-path '$libraries:/usr/lib/x86_64-linux-gnu' "\$program" "\$@"
RUN
chmod +x "$folder/run"
cat "$folder/version"
