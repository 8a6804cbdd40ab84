#!/usr/bin/env python3
"""Compares the Python module with the tool and with C++, as tables for docs/results/python.md:

  PYTHONPATH=build/python/python gonio-papers run --markdown docs/results/python.md --
      bench/python_module.py --build build/python

It needs the targets gonio_python, gonio_tool and example_first_program of that build.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time
import warnings

import numpy as np

import gonio

SOURCE = pathlib.Path(__file__).resolve().parents[1]
DATA = SOURCE / "examples" / "data"
MEASUREMENTS = DATA / "measurements.csv"

# Arguments for the module, and the same for the tool.
METHODS = [
    ("pca", {}, []),
    ("pca", {"noise": 0.02}, ["--noise", "0.02"]),
    ("pca", {"discrepancy": 0.0}, ["--discrepancy", "0"]),
    ("pca", {"solver": "lasso"}, ["--solver", "lasso"]),
    ("linear", {"metric": "log"}, ["--metric", "log"]),
    ("correction", {"gamma": 3.0, "iterations": 5}, ["--gamma", "3", "--iterations", "5"]),
    ("rbf", {}, []),
    ("pull-push", {}, []),
    ("scattered", {}, []),
]


def print_same_numbers(tool, folder):
    print("| `gonio reconstruct` | largest difference of the tables, relative to the largest value | same report |")
    print("|---|---|---|")
    samples = gonio.read_samples(MEASUREMENTS)
    for method, options, arguments in METHODS:
        words = ["--method", method] + arguments
        path = folder / "tool.binary"
        printed = json.loads(subprocess.run(
            [tool, "reconstruct", MEASUREMENTS, "-o", path, "--json"] + words,
            check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout)
        printed.pop("samples")
        found = gonio.reconstruct(samples, method, **options)
        ours, theirs = found.table.values, gonio.read_merl(path).values
        difference = np.abs(ours.astype(float) - theirs).max() / np.abs(theirs).max()
        print(f"| `{' '.join(words)}` | {difference:.1g} | {'yes' if found.details == printed else 'no'} |")


def seconds_of(command, folder):
    start = time.perf_counter()
    subprocess.run(command, cwd=folder, check=True)
    return time.perf_counter() - start


def print_first_program(program, folder, runs):
    for name in ("materials.prior", "measurements.csv"):
        (folder / name).symlink_to(DATA / name)
    commands = [[program], [sys.executable, SOURCE / "examples" / "python" / "first_program.py"]]
    for command in commands:
        seconds_of(command, folder)  # loads the files into memory
    times = [[seconds_of(command, folder) for command in commands] for _ in range(runs)]
    cpp, python = (statistics.median(column) for column in zip(*times))
    ratio = statistics.median(p / c for c, p in times)
    print(f"\n| first program, the whole process, median of {runs} runs in turns | seconds |\n|---|---|")
    print(f"| C++, `examples/learn/first_program.cpp` | {cpp:.2f} |")
    print(f"| Python, `examples/python/first_program.py` | {python:.2f} |")
    print(f"| median of Python's time over C++'s | {ratio:.2f} |")


def address(array):
    return array.__array_interface__["data"][0]


def print_copies():
    table, samples, prior = gonio.Table(), gonio.read_samples(MEASUREMENTS), gonio.read_prior()
    arrays = {
        "`Table.values`": lambda: table.values,
        "`Samples.values`": lambda: samples.values,
        "`Samples.directions`": lambda: samples.directions,
        "`Prior.components`": lambda: prior.components,
    }
    print("\n| array | MB | same address each time | owns no data of its own |\n|---|---|---|---|")
    for name, read in arrays.items():
        one, other = read(), read()
        print(f"| {name} | {one.nbytes / 1e6:.3g} | {'yes' if address(one) == address(other) else 'no'} | "
              f"{'no' if one.flags.owndata else 'yes'} |")
    table.values[:] = 0.25
    written = (table([0, 0, 1], [0, 0, 1]) == 0.25).all()
    print()
    print(f"Does the table return the values that were written to `Table.values`? {'Yes' if written else 'No'}.")


def print_speed(count=1_000_000):
    generator = np.random.default_rng(1)

    def directions():
        z, phi = generator.uniform(0, 1, count), generator.uniform(0, 2 * np.pi, count)
        radius = np.sqrt(1 - z * z)
        return np.stack([radius * np.cos(phi), radius * np.sin(phi), z], axis=1)

    table, wi, wo = gonio.formula_material("red-paint").tabulate(), directions(), directions()
    times = []
    for _ in range(5):
        start = time.perf_counter()
        table(wi, wo, threads=1)
        times.append(time.perf_counter() - start)
    print(f"\nA table evaluated at {count} scattered pairs of directions, one thread: "
          f"{count / min(times) / 1e6:.1f} million a second, the best of 5 runs.")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--build", type=pathlib.Path, required=True, help="folder of the build")
    parser.add_argument("--runs", type=int, default=15, help="of the first program")
    given = parser.parse_args()
    warnings.simplefilter("ignore")  # methods with larger errors warn
    build = given.build.resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        print_same_numbers(build / "bin" / "gonio", folder)
        print_first_program(build / "examples" / "example_first_program", folder, given.runs)
    print_copies()
    print_speed()


if __name__ == "__main__":
    main()
