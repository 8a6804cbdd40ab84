"""Parts of the sources of other programs, cut out of a fetched git directory: nothing of them stands in the project."""

import re
import subprocess
import sys


def git(repository, *words):
    return subprocess.run(["git", "-C", str(repository), *words], check=True, capture_output=True, text=True).stdout


def between(text, begin, end):
    """The lines from the one that begins so up to the one that begins so."""
    found = re.search(rf"^{begin}.*?(?=^{end})", text, re.MULTILINE | re.DOTALL)
    if not found:
        sys.exit(f"{sys.argv[0]}: the fetched sources have no lines from '{begin}' to '{end}'")
    return found.group()
