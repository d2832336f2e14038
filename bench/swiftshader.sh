#!/bin/bash
# Fetches ANGLE with SwiftShader into a folder, for `make peers`: the libraries that come with the npm package
# @sparticuz/chromium (Apache and BSD licences). Needs npm and node. Debian's chromium has SwiftShader, but
# only stubs of ANGLE's libEGL and libGLESv2.
#
#   bench/swiftshader.sh [FOLDER]    build/swiftshader
set -euo pipefail
cd "$(dirname "$0")/.."

folder=${1:-build/swiftshader}
package='@sparticuz/chromium@147.0.0'
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

for tool in npm node; do
    command -v "$tool" >/dev/null || { echo "swiftshader: no $tool, which fetches and unpacks it" >&2 &&
        exit 1; }
done
npm pack "$package" --silent --pack-destination "$work" >/dev/null
tar -xzf "$work"/*.tgz -C "$work" package/bin/swiftshader.tar.br package/LICENSE
mkdir -p "$folder"
node -e 'process.stdout.write(require("zlib").brotliDecompressSync(require("fs").readFileSync(process.argv[1])))' \
    "$work/package/bin/swiftshader.tar.br" | tar -xf - -C "$folder"
cp "$work/package/LICENSE" "$folder/LICENSE.package"
ls "$folder"
