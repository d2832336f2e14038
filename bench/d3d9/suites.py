"""Runs a suite of Wine's Direct3D 9 tests by test function, also beyond a function that crashes or hangs."""

import os
import re
import subprocess

from follow import follow

SUITES = ("stateblock", "d3d9ex", "device", "visual")
COUNTS = ("checks", "passed", "failures", "todo", "better", "unstable", "skipped", "milliseconds")
END = re.compile(r"^@end (\w+) " + " ".join(f"{name} (?P<{name}>\\d+)" for name in COUNTS))
FAILURE = re.compile(r"^(\w+\.c):(\d+):\S* Test failed: (.*)$")
EXCEPTION = re.compile(r"unhandled exception|this is the last test seen")


class Run:
    """One implementation's run of one suite."""

    def __init__(self, command, environment, folder, limit):
        self.command = command  # without the suite
        self.environment = environment
        self.folder = folder  # the working folder, which receives the log
        self.limit = limit  # seconds of one test function
        self.functions = {}
        self.failures = []
        self.current = None

    def line(self, text):
        if text.startswith("@begin "):
            self.current = text.split()[1]
            self.functions[self.current] = {"result": "crash"}
        elif match := END.match(text):
            self.functions[match[1]] = {"result": "end", **{name: int(match[name]) for name in COUNTS}}
            self.current = None
        elif match := FAILURE.match(text):
            place = {"function": self.current, "file": match[1], "line": int(match[2]), "message": match[3]}
            self.failures.append(place)
        elif EXCEPTION.search(text) and self.current:
            self.functions[self.current]["exception"] = text

    def process(self, suite, log, **selection):
        """Runs the functions of the selection (filter.c). Returns false if the process did not reach its end."""
        environment = {**os.environ, **self.environment, **selection}
        process = subprocess.Popen(
            [*self.command, suite],
            cwd=self.folder,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
        hung = not follow(process, self.limit, self.line, log, lambda text: text.startswith("@"))
        if hung:
            subprocess.run(["wineserver", "-k"], check=False)
        process.wait()
        if hung and self.current:
            self.functions[self.current]["result"] = "hang"
        return self.current is None and not hung

    def suite(self, suite, names, reset):
        """Runs all functions. `names` are those of the suite in order; reset() restores the desktop."""
        with open(os.path.join(self.folder, f"{suite}.log"), "wb") as log:
            after = None
            while True:
                self.current = None
                finished = self.process(suite, log, D3D9_AFTER=after or "")
                after = self.current
                if finished or after in (None, names[-1]):
                    break
                reset()
        for name in names:
            self.functions.setdefault(name, {"result": "not run"})

    def repeat(self, suite, reset, runs=3):
        """Runs each function with failures again, in a process of its own; keeps the run with the fewest."""
        for name in [name for name, each in self.functions.items() if each.get("failures") or each["result"] != "end"]:
            kept = self.functions[name], [each for each in self.failures if each["function"] == name]
            others = [each for each in self.failures if each["function"] != name]
            for number in range(2, runs + 1):
                reset()
                self.failures = []
                with open(os.path.join(self.folder, f"{suite}.log"), "ab") as log:
                    self.process(suite, log, D3D9_ONLY=name)
                new = self.functions[name]
                if new["result"] == "end" and new["failures"] < kept[0].get("failures", 1 << 30):
                    kept = new, self.failures
                kept[0]["runs"] = number
                if kept[0].get("failures") == 0:
                    break
            self.functions[name], self.failures = kept[0], others + kept[1]


def function_names(command, suite, environment):
    """The test functions of a suite, in order."""
    environment = {**os.environ, **environment, "D3D9_LIST": "1"}
    text = subprocess.run([*command, suite], env=environment, capture_output=True, text=True, check=True).stdout
    return re.findall(r"^@name (\w+)", text, re.M)


def total(functions, count):
    return sum(each.get(count, 0) for each in functions.values())
