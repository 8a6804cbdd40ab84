#!/usr/bin/env python3
"""A benchmark's times and counters as a Markdown table, for a page of docs/results:

  gonio-papers run --markdown docs/results/solvers.md -- bench/as_table.py build/release/bench/bench_solve_gram
"""
import csv
import subprocess
import sys

if len(sys.argv) < 2:
    sys.exit("usage: as_table.py BENCHMARK ARGUMENTS")
printed = subprocess.run(sys.argv[1:] + ["--benchmark_format=csv"], stdout=subprocess.PIPE, text=True)
if printed.returncode != 0:
    sys.exit(f"as_table.py: {sys.argv[1]} failed")
lines = printed.stdout.splitlines()
start = next((i for i, line in enumerate(lines) if line.startswith("name,")), None)
if start is None:
    sys.exit(f"as_table.py: {sys.argv[1]} printed no benchmark")
rows = list(csv.DictReader(lines[start:]))
left_out = {"iterations", "error_occurred", "error_message"}
columns = [name for name in rows[0] if name not in left_out and any(row[name] for row in rows)]


def cell(text):
    try:
        return f"{float(text):.4g}"
    except (TypeError, ValueError):
        return text or ""


print("| " + " | ".join(columns) + " |")
print("|" + "---|" * len(columns))
for row in rows:
    print("| " + " | ".join(cell(row[name]) for name in columns) + " |")
