#!/usr/bin/env python3
"""Prints a benchmark's times and counters as a Markdown table, for a page of docs/results:

  gonio-papers run --markdown docs/results/solvers.md -- bench/as_table.py build/release/bench/bench_solve_gram

With --across KEY, it prints one number of each benchmark: its time, or the first figure whose name starts with
--figure. Benchmarks whose names differ only in "KEY:value" share a row, with a column for each value.
"""
import argparse
import json
import subprocess
import tempfile

OF_EVERY_RUN = {
    "family_index", "per_family_instance_index", "run_name", "run_type", "repetitions", "repetition_index", "threads",
    "iterations", "error_occurred", "error_message", "aggregate_name", "aggregate_unit", "label"
}


def benchmarks_of(command, parser):
    # Read a file, not the output, because a benchmark's functions may print too.
    with tempfile.NamedTemporaryFile("r", suffix=".json") as file:
        told = subprocess.run(command + ["--benchmark_out=" + file.name, "--benchmark_out_format=json"],
                              stdout=subprocess.DEVNULL)
        if told.returncode != 0:
            parser.error(f"{command[0]} failed")
        found = json.load(file)["benchmarks"]
    if not found:
        parser.error(f"{command[0]} printed no benchmark")
    for benchmark in found:
        benchmark["name"] = benchmark["name"].replace("/real_time", "")
    return found


def cell(value):
    return f"{value:.4g}" if isinstance(value, (int, float)) else value


def print_table(heads, rows):
    print("| " + " | ".join(heads) + " |")
    print("|" + "---|" * len(heads))
    for row in rows:
        print("| " + " | ".join(cell(value) for value in row) + " |")


def print_whole(found):
    names = ["name", "real_time", "cpu_time", "time_unit"]
    names += dict.fromkeys(name for row in found for name in row if name not in OF_EVERY_RUN and name not in names)
    print_table(names, [[row.get(name, "") for name in names] for row in found])


def print_across(found, key, figure, parser):
    rows, values = {}, {}
    figure = next((name for name in found[0] if name.startswith(figure)), None)
    if figure is None:
        parser.error("no figure of the benchmark starts as --figure says")
    for benchmark in found:
        parts = benchmark["name"].split("/")
        value = next((part for part in parts if part.startswith(key + ":")), "")
        row = "/".join(part for part in parts if part != value)
        values[value] = None
        rows.setdefault(row, {})[value] = benchmark.get(figure, "")
    unit = f" ({found[0]['time_unit']})" if figure == "real_time" else ""
    heads = [figure + unit] + [value.replace(":", " ") for value in values]
    print_table(heads, [[name] + [row.get(value, "") for value in values] for name, row in rows.items()])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--across", metavar="KEY")
    parser.add_argument("--figure", default="real_time")
    parser.add_argument("command", nargs=argparse.REMAINDER, metavar="BENCHMARK ARGUMENTS")
    options = parser.parse_args()
    if not options.command:
        parser.error("a benchmark is missing")
    found = benchmarks_of(options.command, parser)
    if options.across:
        print_across(found, options.across, options.figure, parser)
    else:
        print_whole(found)


if __name__ == "__main__":
    main()
