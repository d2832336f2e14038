"""Runs experiments and keeps their outputs, a folder each: RESULTS/claims/NAME/.

Its file run.json is written last, when all commands have ended; without it the experiment has not been run. It has the digest
of the commands, the commit and the machine. --resume uses outputs with the same digest, in any order, from any run, and
--older also those that differ in the commit.
"""

import hashlib
import json
import os
import shutil
import signal
import subprocess
import sys
import time

from expression import items_at
from number import NoValue

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
LIMIT_FACTOR, LIMIT_LEAST = 5, 60  # seconds: a command may take five times what its experiment usually takes


class Machine:
    """What results depend on, besides the commands."""

    def __init__(self, triptych):
        self.facts = {
            "cpu": processor(),
            "cores": os.cpu_count(),
            "kernel": " ".join((os.uname().sysname, os.uname().release, os.uname().machine)),
            "commit": output_of("git", "-C", ROOT, "describe", "--always", "--dirty") or "unknown",
            "compiler": "gcc " + output_of(os.environ.get("CC", "cc"), "-dumpfullversion"),
            "engines": engines(triptych),
        }
        self.facts["widest"] = widest(self.facts["engines"])

    def digest(self, runs, commit=None):
        facts = {key: self.facts[key] for key in ("cpu", "cores", "commit")}
        facts["commit"] = commit or facts["commit"]
        text = json.dumps([facts, os.environ.get("TRIPTYCH_CPU", ""), sorted(runs.items())], sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()[:16]


def processor():
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            names = [line.split(":", 1)[1].strip() for line in file if line.startswith("model name")]
        return names[0] if names else "unknown"
    except OSError:
        return "unknown"


def output_of(*command):
    try:
        return subprocess.run(command, capture_output=True, text=True, check=False).stdout.strip()
    except OSError:
        return ""


def engines(triptych):
    try:
        return [each for each in json.loads(output_of(triptych, "list", "engines", "--json") or "[]")]
    except json.JSONDecodeError:
        return []


def widest(found):
    """The lanes and instruction set of specialize."""
    wide = any(each["engine"] == "specialize-16" and each["here"] == "available" for each in found)
    return {"lanes": "16/8/16", "instruction_set": "AVX-512"} if wide else {"lanes": "8", "instruction_set": "AVX2"}


class Laboratory:
    def __init__(self, registry, machine, folder, triptych, resume=False, older=False):
        self.registry, self.machine, self.resume, self.older = registry, machine, resume or older, older
        self.folder = os.path.join(os.path.abspath(folder), "claims")
        self.environment = dict(os.environ, PATH=os.path.dirname(os.path.abspath(triptych)) + ":" + os.environ["PATH"])
        self.environment["BUILD"] = os.path.dirname(os.path.abspath(triptych))
        self.failures, self.reports, self.loaded = {}, {}, {}

    def run_all(self, names):
        for at, name in enumerate(names, 1):
            experiment = self.registry.experiments[name]
            report = self.kept(experiment) if self.resume else None
            print(f"[{at}/{len(names)}] {name}: ", end="", file=sys.stderr, flush=True)
            report = report or self.run(experiment)
            self.reports[name] = report
            if report["failed"]:
                self.failures[name] = report["failed"]
            print(report["failed"] or f"{report['seconds']:.0f} s", file=sys.stderr, flush=True)

    def kept(self, experiment):
        try:
            with open(os.path.join(self.folder, experiment.name, "run.json"), encoding="utf-8") as file:
                report = json.load(file)
        except (OSError, json.JSONDecodeError):
            return None
        commit = report["machine"]["commit"] if self.older else None
        same = report.get("digest") == self.machine.digest(experiment.runs, commit)
        return report if same and not report["failed"] else None

    def run(self, experiment):
        folder = os.path.join(self.folder, experiment.name)
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        started, failed = time.monotonic(), ""
        for name, command in experiment.runs.items():
            failed = failed or self.execute(experiment, name, command, os.path.join(folder, name))
        report = {
            "experiment": experiment.name,
            "digest": self.machine.digest(experiment.runs),
            "machine": self.machine.facts,
            "commands": experiment.runs,
            "date": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime()),
            "seconds": round(time.monotonic() - started, 1),
            "failed": failed,
        }
        write_json(os.path.join(folder, "run.json"), report)
        return report

    def execute(self, experiment, name, command, path):
        """Returns why the command failed, or an empty text. It writes $OUT, or its standard output is the output."""
        limit = max(LIMIT_LEAST, LIMIT_FACTOR * experiment.takes)
        environment = dict(self.environment, OUT=path)
        with open(path + ".said", "wb") as said, open(path + ".errors", "wb") as errors:
            process = subprocess.Popen(
                ["bash", "-c", "set -euo pipefail\n" + command],
                stdin=subprocess.DEVNULL,
                stdout=said,
                stderr=errors,
                env=environment,
                cwd=ROOT,
                start_new_session=True,
            )
            status = wait(process, limit)
        if status is None:
            return f"{name} took more than {limit} s"
        if status:
            return f"{name} ended with status {status}: {last_line(path + '.errors')}"
        if not os.path.exists(path):
            os.rename(path + ".said", path)
        return ""

    def read(self, output, path):
        """The items of a reference (expression.py). Raises NoValue if the experiment failed."""
        experiment, _, run = output.partition(".")
        if experiment in self.failures:
            raise NoValue(f"the experiment {experiment} failed: {self.failures[experiment]}")
        if output not in self.loaded:
            self.loaded[output] = load(os.path.join(self.folder, experiment, run))
        content = self.loaded[output]
        if path is None:
            return [content if isinstance(content, str) else json.dumps(content)]
        return items_at(content, path)


    def bytes(self, output):
        """The content of an output that is a picture. Raises NoValue if the experiment failed."""
        experiment, _, run = output.partition(".")
        if experiment in self.failures:
            raise NoValue(f"the experiment {experiment} failed: {self.failures[experiment]}")
        path = os.path.join(self.folder, experiment, run)
        try:
            with open(path, "rb") as file:
                content = file.read()
        except OSError as error:
            raise NoValue(f"{path}: {error.strerror}") from None
        if content[:4] != b"\x89PNG" and not content.startswith(b"<svg"):
            raise NoValue(f"{path} is not a PNG or SVG picture")
        return content


def wait(process, limit):
    """The status of a process, or None if it was ended after `limit` seconds, with all that it started."""
    try:
        return process.wait(limit)
    except BaseException as reason:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        if isinstance(reason, subprocess.TimeoutExpired):
            return None
        raise


def last_line(path):
    with open(path, encoding="utf-8", errors="replace") as file:
        lines = file.read().strip().splitlines()
    return lines[-1] if lines else "no message"


def load(path):
    """JSON if the output begins like it, else text."""
    try:
        with open(path, encoding="utf-8") as file:
            text = file.read()
        return json.loads(text) if text[:1] in "{[" and text else text
    except OSError as error:
        raise NoValue(f"{path}: {error.strerror}") from None
    except json.JSONDecodeError as error:
        raise NoValue(f"{path}: not JSON: {error}") from None


def write_json(path, content):
    with open(path + ".new", "w", encoding="utf-8") as file:
        json.dump(content, file, indent=1)
        file.write("\n")
    os.replace(path + ".new", path)
