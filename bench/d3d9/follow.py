"""Follows the lines of a program that may crash or hang."""

import os
import selectors
import signal
import time


def follow(process, limit, line, log=None, alive=lambda text: True):
    """Passes each line of the output to line(). `process` has a pipe as its output and a session of its own. If no line
    that is `alive` came for `limit` seconds, ends the session and returns False. The bytes go to `log`, too."""
    selector = selectors.DefaultSelector()
    selector.register(process.stdout, selectors.EVENT_READ)
    last, rest = time.monotonic(), b""
    while True:
        if selector.select(timeout=min(limit, 1)):
            data = os.read(process.stdout.fileno(), 65536)
            if not data:
                return True
            if log:
                log.write(data)
            *lines, rest = (rest + data).split(b"\n")
            for each in lines:
                text = each.decode("utf-8", "replace").rstrip("\r")
                last = time.monotonic() if alive(text) else last
                line(text)
        if time.monotonic() - last > limit:
            os.killpg(process.pid, signal.SIGKILL)
            return False
