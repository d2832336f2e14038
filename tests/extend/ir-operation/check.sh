#!/bin/bash
# The operation that change.patch adds, max_x: the larger ones of two pairs. The tests of all
# operations take the new row from the table. They compare the recorder's folding, the emulator, the batch
# interpreter, the specializer with 4, 8 and 16 lanes and the stitcher with the row's expression,
# for all operand forms and edge values.
set -euo pipefail

grep -q '^OP(max_x,' src/def/op.def
build=${BUILD#"$PWD"/}
programs=("$build"/tests/{spec/operation,engines/specialize/operation,engines/stitch/operation,emu/batch/batch})
make --no-print-directory BUILD="$build" CFLAGS=-O0 "${programs[@]}"
for program in "${programs[@]}"; do
    said=$(QUICK=1 "$program")
    grep -qE '^[1-9][0-9]* Tests 0 Failures' <<<"$said"
done
"$TRIPTYCH" verify bench/streams/teapot-bilinear.tri --frames 1 --threads 1,2 | tail -1 | grep -q identical
