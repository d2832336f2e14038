"""What a report of a measurement needs besides its numbers: the machine, the commit, the engine's lanes."""

import datetime
import json
import os
import platform
import subprocess
import tempfile


def output(*command):
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout.strip()


def processor():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        for line in file:
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    return platform.machine()


def machine():
    """The same fields as `triptych bench --json` has."""
    return {
        "cpu": processor(),
        "cores": len(os.sched_getaffinity(0)),
        "kernel": f"{platform.system()} {platform.release()} {platform.machine()}",
        "compiler": "gcc " + output("gcc", "-dumpfullversion"),
        "commit": output("git", "describe", "--always", "--dirty"),
        "date": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"),
    }


def engine(command, name):
    """The lanes and the instruction set of an engine, from a measurement of one frame."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "bench.json")
        options = ["--engines", name, "--frames", "1", "--repetitions", "3", "--seconds", "0.1", "--json", path]
        subprocess.run([command, "bench", *options, "bench/streams/teapot-flat.tri"], capture_output=True, check=True)
        with open(path, encoding="utf-8") as file:
            row = json.load(file)["streams"][0]["engines"][0]
    return {"engine": name, "lanes": row["lanes"], "instruction_set": row["instruction_set"]}


WINE = ("wine", "libwine", "libgl1-mesa-dri")


def renderers(*packages):
    """The versions of the packages that are compared with."""
    lines = output("dpkg-query", "-W", "-f", "${Package} ${Version}\n", *packages).splitlines()
    return dict(line.split(" ", 1) for line in lines)
