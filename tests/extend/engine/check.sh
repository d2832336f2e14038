#!/bin/bash
# The new engine is listed, and its pictures are those of the emulator.
set -euo pipefail
"$TRIPTYCH" list engines | grep "^ *batch-units " >/dev/null
"$TRIPTYCH" verify bench/streams/teapot-bilinear.tri --engines emulate,batch-units --frames 1 --threads 1,2 | tail -1 | grep -q identical
