"""Runs a list of cases of a suite of Khronos' dEQP, also beyond a case that crashes or hangs."""

import collections
import os
import re
import signal
import subprocess
import tempfile

from follow import follow

# The results that the program prints of a case, and those that the runner adds.
SAID = ("Pass", "QualityWarning", "CompatibilityWarning", "Waiver", "NotSupported", "Fail", "InternalError", "ResourceError")
ADDED = ("Crash", "Timeout", "Missing")
GOOD = ("Pass", "QualityWarning", "CompatibilityWarning", "Waiver", "NotSupported")
CASE = re.compile(r"^Test case '(.+)'\.\.")
RESULT = re.compile(r"^  (\w+) \((.*)\)\s*$")
TEXT = re.compile(r"<Text>(.*?)</Text>")
OPTIONS = (
    "--deqp-log-images=disable",
    "--deqp-log-shader-sources=disable",
    "--deqp-watchdog=disable",
    "--deqp-crashhandler=disable",
    "--deqp-gl-config-name=rgba8888d24s8ms0",
    "--deqp-surface-width=256",
    "--deqp-surface-height=256",
)
VAIN = 3  # as many starts in a row without a case end the run

Result = collections.namedtuple("Result", "status message")


def read_list(path):
    with open(path, encoding="utf-8") as file:
        return file.read().split()


class Run:
    """One implementation's run of a list."""

    def __init__(self, command, environment, limit, suite):
        self.command = command  # ends with the path of the program, whose data files are beside it
        self.environment = {**os.environ, **environment}
        self.limit = limit  # seconds without a line
        self.suite = suite
        self.results = {}
        self.outside = []  # ends of the program that no case explains
        self.current = None

    def line(self, text):
        if match := CASE.match(text):
            self.finish("Missing", "no result")
            self.current = match[1]
        elif match := RESULT.match(text):
            self.finish(match[1] if match[1] in SAID else "Missing", match[2])

    def finish(self, status, message):
        if self.current:
            self.results[self.current] = Result(status, message)
        self.current = None

    def start(self, selection, log="/dev/null"):
        """Runs the program once. Returns its exit status, or None if it hung."""
        process = subprocess.Popen(
            [*self.command, *OPTIONS, *self.suite.options, *selection, "--deqp-log-filename=" + log],
            cwd=os.path.dirname(self.command[-1]),
            env=self.environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
        ended = follow(process, self.limit, self.line)
        process.stdout.close()
        status = process.wait()
        return status if ended else None

    def some(self, cases):
        """Runs the cases until the program ends. What it was in the middle of has a result too."""
        with tempfile.NamedTemporaryFile("w", suffix=".txt") as file:
            file.write("\n".join(cases) + "\n")
            file.flush()
            status = self.start(["--deqp-caselist-file=" + file.name])
        if status is None:
            self.finish("Timeout", f"no line in {self.limit:g} s")
        elif self.current:
            self.finish("Crash", signal.Signals(-status).name if status < 0 else f"exit status {status}")
        elif status not in (0, 1):
            self.outside.append(signal.Signals(-status).name if status < 0 else f"exit status {status}")
        return status

    def all(self, cases, progress=lambda done: None):
        """Runs all cases. Returns False if the program cannot run at all."""
        left, vain = list(cases), 0
        while left and vain < VAIN:
            status = self.some(left)
            after = [case for case in left if case not in self.results]
            vain = vain + 1 if len(after) == len(left) else 0
            left = after
            progress(len(self.results))
            if status == 0:
                break
        for case in left:
            self.results[case] = Result("Missing", "not run")
        return vain < VAIN

    def driver(self):
        """The strings of the implementation that answers, from the log of the cases that ask for them."""
        found = {}
        for name in self.suite.strings:
            with tempfile.NamedTemporaryFile("r", suffix=".qpa", encoding="utf-8", errors="replace") as log:
                self.start([f"--deqp-case={self.suite.prefix}info.{name}"], log.name)
                texts = TEXT.findall(log.read())
            found[name] = texts[0] if texts else ""
        self.results = {}
        return found
