#!/bin/bash
# The measurement of `make bench-clients`: kernels that are not graphics, plain C and libraries.
#
#   bench/clients.sh [--counts FILE]
#
# Compares CASES random cases (300) of each client with its library, measures all ways on one and two threads,
# and counts executed instructions with valgrind, which has no AVX-512, for engines of 1 to 16 lanes. Writes
# results/clients.json (RESULTS). --counts compares and counts only, without the libraries, and writes FILE.
# Ends with 1 if a result differs.
set -euo pipefail
cd "$(dirname "$0")/.."
program=${BUILD:-build}/bench/clients
results=${RESULTS:-results}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

executed() # JOB WAY RUNS: instructions of the whole process
{
    TRIPTYCH_CPU=-avx512f valgrind --tool=callgrind --callgrind-out-file=/dev/null \
        "$program" --run "$1" "$2" "$3" 2>&1 | sed -n 's/.*Collected : *\([0-9]*\).*/\1/p'
}

file=${2-$results/clients.json}
ways='plain library specialize-1 specialize-4 specialize-8 specialize-8x2'
"$program" --compare "${CASES:-300}"
if [[ ${1-} == --counts ]]; then
    ways='plain specialize-1 specialize-4 specialize-8 specialize-8x2'
    echo '{"jobs": []}' >"$work/times.json"
else
    mkdir -p "$results"
    "$program" --json "$work/times.json"
fi

echo 'executed instructions a byte of input:'
while IFS=$'\t' read -r job bytes; do
    for way in $ways; do
        once=$(executed "$job" "$way" 1)
        twice=$(executed "$job" "$way" 2)
        printf '%s\t%s\t%s\n' "$job" "$way" "$(awk -v n=$((twice - once)) -v b="$bytes" 'BEGIN { printf "%.3f", n / b }')"
    done
done < <("$program" --jobs) | tee "$work/counts"

python3 - "$work" "$file" <<'END'
import json, sys

work, path = sys.argv[1:]
report = json.load(open(f"{work}/times.json"))
report["counts"] = [
    {"client": job.split(",")[0].split()[0], "job": job, "way": way, "instructions_a_byte": float(count)}
    for job, way, count in (line.rstrip("\n").split("\t") for line in open(f"{work}/counts"))
]
with open(path, "w") as file:
    json.dump(report, file, indent=1)
    file.write("\n")
END
