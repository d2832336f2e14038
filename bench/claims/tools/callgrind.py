"""Counts the instructions and branches of routines, from the files of valgrind's callgrind, as JSON.

    python3 bench/claims/tools/callgrind.py ENGINE STREAM

Runs `triptych render` of the stream's first frame under callgrind, without AVX-512, which valgrind does not have. Generated code
belongs to no file, so its counts are those of functions without one. The routines of emulate are its functions emulate_vertex,
emulate_setup and emulate_pixel with all that they call. An engine mixed can have both. The number of shaded pixels comes from `triptych inspect`.
"""

import collections
import json
import os
import re
import subprocess
import sys
import tempfile

NAME = re.compile(r"(c?)(fn|ob|fl|fi|fe)=\((\d+)\)(?: (.*))?$")
EVENTS = ("instructions", "branches", "mispredicted", "indirect", "indirect_mispredicted")


class Profile:
    """Costs of functions by themselves, and of calls by (caller, called)."""

    def __init__(self, path):
        self.names = {"fn": {}, "ob": {}}
        self.own, self.calls = collections.defaultdict(lambda: [0] * 5), collections.defaultdict(lambda: [0] * 5)
        self.objects = {}
        with open(path, encoding="utf-8", errors="replace") as file:
            self.read(file)

    def read(self, file):
        function, called, objekt, called_object, is_call = None, None, "", "", False
        for line in file:
            match = NAME.match(line.strip())
            if match:
                is_called, kind, number, name = match.groups()
                table = self.names["fn" if kind == "fn" else "ob"] if kind in ("fn", "ob") else {}
                if name is not None:
                    table[number] = name
                text = table.get(number, "")
                if kind == "ob":
                    objekt, called_object = (objekt, text) if is_called else (text, called_object)
                elif kind == "fn" and is_called:
                    called = text
                elif kind == "fn":
                    function, called_object = text, objekt
                    self.objects[function] = objekt
            elif line.startswith("calls="):
                is_call = True
            elif line[:1] in "0123456789+-*":
                costs = [int(each) for each in line.split()[1:]]
                table, key = (self.calls, (function, called)) if is_call else (self.own, function)
                for at, cost in enumerate(costs):
                    table[key][at] += cost
                is_call = False


def total(lists):
    return dict(zip(EVENTS, (sum(column) for column in zip(*lists, [0] * 5))))


def is_emulator(name):
    return re.fullmatch(r"emulate_(vertex|setup|pixel)(\..*)?", name) is not None


def routines(profile, engine):
    emulated = [cost for (caller, called), cost in profile.calls.items() if is_emulator(called) and not is_emulator(caller)]
    generated = [cost for name, cost in profile.own.items() if profile.objects[name] in ("", "???")]
    if engine.startswith("mixed"):
        return emulated + generated
    return emulated if engine.startswith("emulate") else generated


def pixels(stream, folder):
    report = os.path.join(folder, "inspect.json")
    run("triptych", "inspect", stream, "--overdraw", os.path.join(folder, "o.png"), "--count", "shaded", "--json", report)
    with open(report, encoding="utf-8") as file:
        return sum(draw["shaded"] for draw in json.load(file)["draws"])


def run(*command):
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def main():
    engine, stream = sys.argv[1:]
    os.environ["TRIPTYCH_CPU"] = "-avx512f"
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "callgrind.out")
        tool = ("valgrind", "--tool=callgrind", "--branch-sim=yes", "--compress-strings=yes", f"--callgrind-out-file={path}")
        picture = os.path.join(folder, "p.png")
        run(*tool, "triptych", "render", stream, "--engine", engine, "--threads", "1", "--compression", "0", "--out", picture)
        profile = Profile(path)
        result = {"engine": engine, "stream": stream, "pixels": pixels(stream, folder)}
        result["routines"] = total(routines(profile, engine))
        result["all"] = total(profile.own.values())
    print(json.dumps(result, indent=1))


main()
