#!/bin/bash
# Compiles and runs a program of bench/claims/programs. A file NAME.asm beside NAME.c is assembled and linked.
#
#   bench/claims/tools/program.sh NAME
set -euo pipefail
program=$(mktemp)
trap 'rm -f "$program" "$program.o"' EXIT
source=bench/claims/programs/$1
objects=()
if [[ -f $source.asm ]]; then
    nasm -f elf64 "$source.asm" -o "$program.o"
    objects=("$program.o")
fi
"${CC:-cc}" -std=gnu17 -O2 -ffp-contract=off -Isrc "$source.c" "${objects[@]}" -o "$program" -lm
"$program"
