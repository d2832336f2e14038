#!/bin/bash
# The operation that change.patch adds, max_x: the larger ones of two pairs. The tests of all
# operations take the new row from the table. They compare the recorder's folding, the emulator, the batch
# interpreter, the specializer with 4, 8 and 16 lanes and the stitcher with the row's expression,
# for all operand forms and edge values.
set -euo pipefail

grep -q '^OP(max_x,' src/def/op.def
for tests in spec/operation engines/specialize/operation engines/stitch/operation emu/batch/batch; do
    QUICK=1 make --no-print-directory BUILD="${BUILD#"$PWD"/}" CFLAGS=-O0 check ONLY="$tests" | grep -qE '^[0-9]+ passed, 0 failed$'
done
"$TRIPTYCH" verify bench/streams/teapot-bilinear.tri --frames 1 --threads 1,2 | tail -1 | grep -q identical
