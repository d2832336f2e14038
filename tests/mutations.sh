#!/usr/bin/env bash
# Every planted bug of tests/mutations/table.txt fits its file: the lines that it replaces occur there exactly
# once. `make mutations` plants them.
# Runs once.
set -u
cd "$(dirname "$0")/.." || exit 1

if misfits=$(tests/mutations/run.sh --fit 2>&1); then
    echo "ok every planted bug fits its file"
else
    echo "FAIL every planted bug fits its file"
    printf '%s\n' "$misfits" >&2
    exit 1
fi
