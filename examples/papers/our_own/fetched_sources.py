"""Extracts parts of other programs' sources from a fetched git directory. The project contains none of them."""

import re
import subprocess
import sys


def git(repository, *words):
    return subprocess.run(["git", "-C", str(repository), *words], check=True, capture_output=True, text=True).stdout


def between(text, begin, end):
    """Returns the lines from the one that starts with `begin` up to the one that starts with `end` (patterns)."""
    found = re.search(rf"^{begin}.*?(?=^{end})", text, re.MULTILINE | re.DOTALL)
    if not found:
        sys.exit(f"{sys.argv[0]}: the fetched sources have no lines from '{begin}' to '{end}'")
    return found.group()
