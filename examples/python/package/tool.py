"""Runs the tool that the wheel contains."""

import os
import pathlib
import sys


def main() -> None:
    tool = pathlib.Path(__file__).with_name("bin") / "gonio"
    os.execv(tool, [str(tool), *sys.argv[1:]])
