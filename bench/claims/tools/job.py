"""The words of a draw's job that the routine of each stage reads, from their recordings, as JSON.

    python3 bench/claims/tools/job.py STREAM...

The first draw of each stream. A word is a named field. "bytes" are of distinct words that a stage reads, "alone" of those that no
other stage does, "all" of those that any of them reads. TRIPTYCH is the command; by default it is in the path.
"""

import json
import os
import re
import subprocess
import sys

STAGES = ("vertex", "setup", "pixel")
WORD = re.compile(r"\bJOB ([\w.\[\]]+)")


def words(stream, stage):
    triptych = os.environ.get("TRIPTYCH", "triptych")
    command = [triptych, "dump", stream, "--unit", stage, "--engine", "specialize-8", "--show", "record"]
    dumped = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    return set(WORD.findall(dumped))


def main():
    rows = []
    for stream in sys.argv[1:]:
        read = {stage: words(stream, stage) for stage in STAGES}
        everything = set().union(*read.values())
        for stage in STAGES:
            others = set().union(*(read[other] for other in STAGES if other != stage))
            rows.append({
                "stream": stream,
                "stage": stage,
                "bytes": 4 * len(read[stage]),
                "alone": 4 * len(read[stage] - others),
                "all": 4 * len(everything),
            })
    json.dump({"stages": rows}, sys.stdout, indent=1)


main()
