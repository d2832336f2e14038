#!/bin/bash
# Compiles and runs a program of bench/claims/programs.
#
#   bench/claims/tools/program.sh NAME
set -euo pipefail
program=$(mktemp)
trap 'rm -f "$program"' EXIT
"${CC:-cc}" -std=gnu17 -O2 -ffp-contract=off -Isrc "bench/claims/programs/$1.c" -o "$program" -lm
"$program"
