"""Counts the words and signs of C functions, as JSON: {"FUNCTION": COUNT, ...}.

    python3 bench/claims/tools/tokens.py FILE FUNCTION...
"""
import json
import re
import sys


def body(text, function):
    """The text between the braces of a function's definition, which begins a line and ends one."""
    definition = r"^[^\n]*\b%s\([^;{]*\)\n\{\n(.*?)^\}" % re.escape(function)
    found = re.search(definition, text, re.MULTILINE | re.DOTALL)
    if not found:
        sys.exit("tokens.py: no function %s" % function)
    return found.group(1)


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        text = file.read()
    token = re.compile(r"[A-Za-z_]\w*|\d[\w.]*|->|[^\s\w]")
    print(json.dumps({name: len(token.findall(body(text, name))) for name in sys.argv[2:]}))


main()
