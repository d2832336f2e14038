"""Reads results/ and answers queries about single numbers.

A query is a function that is decorated with @number. Its arguments are words of a mark (see __main__.py).
Files are read when a query first needs them. A query that finds nothing raises KeyError, and the page is reported.
"""

import csv
import json
import math
import os
import re

folder = "results"
numbers = {}
_cache = {}


def number(function):
    numbers[function.__name__.replace("_", "-")] = function
    return function


def load(name):
    """The contents of a results file: parsed JSON, the rows of a CSV, or text. A bare name means NAME.json."""
    if "." not in name:
        name += ".json"
    if name not in _cache:
        with open(os.path.join(folder, name), encoding="utf-8", newline="") as file:
            if name.endswith(".json"):
                _cache[name] = json.load(file)
            elif name.endswith(".csv"):
                _cache[name] = list(csv.DictReader(file))
            else:
                _cache[name] = file.read()
    return _cache[name]


def read_files():
    """The names of the files that load() has read."""
    return sorted(_cache)


def only(items, source, **wanted):
    """The one item whose fields have the wanted values."""
    found = items
    for key, value in wanted.items():
        text = str(value)
        found = [item for item in found if str(item.get(key)) == text]
    if len(found) != 1:
        raise KeyError(f"{source}: {len(found)} entries with {wanted}, expected one")
    return found[0]


def geometric_mean(values):
    values = [value for value in values if value > 0]
    if not values:
        raise KeyError("no values for a mean")
    return math.exp(sum(map(math.log, values)) / len(values))


# --- Streams: bench.json, baselines.json, flow.json ------------------------------------------------------------


def stream_row(file, stream, engine):
    streams = load(file)["streams"]
    return only(only(streams, file, stream=stream)["engines"], f"{file} {stream}", engine=engine)


@number
def stream(file, name, engine, column):
    """COLUMN of an engine on a stream; NAME `mean` is the geometric mean over the file's streams."""
    if name != "mean":
        return stream_row(file, name, engine)[column]
    return geometric_mean(
        only(each["engines"], each["stream"], engine=engine)[column] for each in load(file)["streams"]
    )


@number
def unit_build(file, engine, unit, quantity, statistic):
    """A STATISTIC (median, p99 ...) of build_us or code_bytes over an engine's routines of a unit."""
    return only(load(file)["builds"], file, engine=engine, unit=unit)[quantity][statistic]


@number
def build(engine, what, statistic):
    """A STATISTIC of builds.json: WHAT is a unit or `set`, the three routines of a draw."""
    return only(load("builds")["builds"], "builds", engine=engine, what=what)[statistic + "_us"]


@number
def cold(stream_name, engine, column):
    return only(load("cold")["cold"], "cold", stream=stream_name, engine=engine)[column]


# --- Shaders: shaders.json ---------------------------------------------------------------------------------------


def shader_rows(unit="all", least=1, most=1 << 32):
    return [
        row
        for row in load("shaders")["shaders"]
        if unit in ("all", row["unit"]) and row["elements"] > 0 and least <= row["slots"] <= most
    ]


def shader_value(row, engine, column):
    return max(only(row["engines"], row["shader"], engine=engine)[column], 1e-3)


def shader_column(rows, engine, column):
    return geometric_mean(shader_value(row, engine, column) for row in rows)


@number
def shader_mean(unit, engine, column="ns", least="1", most="4294967296"):
    """Geometric mean over the shaders of a unit (vertex, pixel, all) with LEAST to MOST slots."""
    return shader_column(shader_rows(unit, int(least), int(most)), engine, column)


@number
def shader_least(unit, engine, column="ns"):
    return min(shader_value(row, engine, column) for row in shader_rows(unit))


@number
def shader_most(unit, engine, column="ns"):
    return max(shader_value(row, engine, column) for row in shader_rows(unit))


@number
def shader_count():
    return len(load("shaders")["shaders"])


@number
def shader_slots(which):
    return {"least": min, "most": max}[which](row["slots"] for row in load("shaders")["shaders"])


def worst_shaders(first, second, count):
    """The shaders with the largest quotient of FIRST's time to SECOND's: (quotient, name), the largest first."""
    quotients = [
        (shader_value(row, first, "ns") / shader_value(row, second, "ns"), row["shader"]) for row in shader_rows()
    ]
    return sorted(quotients, reverse=True)[: int(count)]


# --- Renderers: peers.json ----------------------------------------------------------------------------------------


def workload(name):
    return only(load("peers")["workloads"], "peers", name=name)


def cell(name, renderer, cores="one"):
    return only(workload(name)["results"], name, renderer=renderer, cores=cores)


@number
def peer(name, renderer, cores="one"):
    return cell(name, renderer, cores)["value"]


def best_peer(name, renderer="specialize"):
    """The fastest peer of a workload: the one whose quotient with RENDERER is that against the best peer."""
    own = cell(name, renderer)
    for other in workload(name)["results"]:
        if other["cores"] == "one" and other.get("against_best_peer", [0])[0] == 1 and is_peer(other["renderer"]):
            return other["renderer"]
    raise KeyError(f"{name}: no best peer of {own['renderer']}")


def is_peer(name):
    return name in ("softpipe", "llvmpipe", "llvmpipe-newest", "swiftshader")


@number
def against(name, renderer, other, cores="one"):
    """How many times as fast RENDERER is as OTHER (llvmpipe, best_peer, swgl ...), the median over the passes."""
    return cell(name, renderer, cores)["against_" + other][0]


@number
def mean(renderer, other, group, cores="one"):
    """A geometric mean of peers.json: OTHER is a renderer or `best-peer`; GROUP as the report names it."""
    wanted = {"renderer": renderer, "group": group, "cores": cores}
    if other != "best-peer":
        wanted["against"] = other
    means = [entry for entry in load("peers")["geometric_means"] if other != "best-peer" or "against" not in entry]
    return only(means, "geometric_means", **wanted)["mean"]


@number
def mean_count(renderer, other, group, cores="one"):
    means = load("peers")["geometric_means"]
    return only(means, "geometric_means", renderer=renderer, against=other, group=group, cores=cores)["workloads"]


@number
def limit(name):
    """What one core can do at most, in thousands of millions a second (bench/peers/limits.c)."""
    return load("peers")["limits"][name]


# --- Checks: verify.json, matrix.txt, coverage.txt, mutations.md, fuzz.json ------------------------------------


@number
def verify(what):
    report = load("verify")
    frames = sum(each["frames"] for each in report["streams"])
    return {"streams": len(report["streams"]), "engines": len(report["engines"]), "frames": frames}[what]


@number
def matrix(what):
    found = re.search(r"^(\d+) combinations", load("matrix.txt"), re.M)
    if what != "combinations" or not found:
        raise KeyError("matrix.txt")
    return int(found[1])


@number
def coverage(what):
    words = load("coverage.txt").splitlines()[-1].split()
    return {"lines": int(words[1]), "percent": float(words[3])}[what]


@number
def mutations(what):
    found = re.search(r"^(\d+) of (\d+) found", load("mutations.md"), re.M)
    return int(found[{"found": 1, "planted": 2}[what]])


def campaigns():
    """The reports of `triptych fuzz --json` in fuzz.json, in the order in which they ran."""
    return load("fuzz")["campaigns"]


@number
def fuzz(what, which="most"):
    """A count of the campaign with the most cases, or of the last one."""
    runs = campaigns()
    run = max(runs, key=lambda each: each["cases"]) if which == "most" else runs[-1]
    return len(run["engines"]) if what == "engines" else run[what]
