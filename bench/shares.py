#!/usr/bin/env python3
"""Prints how close benchmarks come to the machine's limits, as a Markdown table for docs/results/benchmarks.md:

  gonio-papers run --markdown docs/results/benchmarks.md -- bench/shares.py build/release/bench/bench_solve_gram

A benchmark names its limits: other benchmarks of the program (bench/limit.hpp). Its share is its rate relative to the
binding limit's. With --before PROGRAM, an older build of the same program runs between the rounds of this one, and
"times" is the speed-up of this one. All figures are medians over --rounds.
"""
import argparse
import statistics

from as_table import benchmarks_of, cell, print_table

RATES = ["GFlop/s", "GB/s", "items_per_second", "bytes_per_second"]
UNITS = {"items_per_second": (1e-6, "M/s"), "bytes_per_second": (1e-9, "GB/s")}


def rates_of(benchmark):
    """Returns a benchmark's rates by their units."""
    found = {}
    for name in RATES:
        if name in benchmark:
            factor, unit = UNITS.get(name, (1.0, name))
            found[unit] = factor * benchmark[name]
    return found


class rounds:
    """The benchmarks of a program by name, with all their rounds."""

    def __init__(self):
        self.of = {}

    def add(self, benchmarks):
        for benchmark in benchmarks:
            self.of.setdefault(benchmark["name"], []).append(benchmark)

    def time(self, name):
        return statistics.median(benchmark["real_time"] for benchmark in self.of[name])

    def rates(self, name):
        of_rounds = [rates_of(benchmark) for benchmark in self.of[name]]
        return {unit: statistics.median(rates[unit] for rates in of_rounds) for unit in of_rounds[0]}


def limits_of(benchmark):
    """Returns [(factor, name)]; empty for a benchmark without limits."""
    label = benchmark.get("label", "")
    if not label.startswith("limit: "):
        return []
    parsed = []
    for each in label.removeprefix("limit: ").split("; "):
        factor, times, name = each.partition(" x ")
        parsed.append((float(factor), name) if times else (1.0, each))
    return parsed


def binding(found, name, parser):
    """Returns (share, unit, own rate, limit's rate, limit's name) of the limit with the largest share."""
    shares = []
    for factor, limit in limits_of(found.of[name][0]):
        if limit not in found.of:
            parser.error(f"{name} names the limit {limit}, which did not run")
        own, its = found.rates(name), found.rates(limit)
        unit = next((unit for unit in own if unit in its), None)
        if unit is None:
            parser.error(f"{name} and its limit {limit} have no rate in common")
        words = limit if factor == 1.0 else f"{factor:g} x {limit}"
        shares.append((own[unit] / (factor * its[unit]), unit, own[unit], factor * its[unit], words))
    return max(shares)


def rows_of(found, before, parser):
    for name in found.of:
        if not limits_of(found.of[name][0]):
            continue
        share, unit, own, its, limit = binding(found, name, parser)
        row = [name, f"{cell(found.time(name))} {found.of[name][0]['time_unit']}", f"{own:.3g} {unit}", limit,
               f"{its:.3g} {unit}", f"{100.0 * share:.0f} %"]
        if before is not None:
            known = name in before.of
            row += [f"{cell(before.time(name))} {before.of[name][0]['time_unit']}" if known else "",
                    f"{before.time(name) / found.time(name):.2f}" if known else ""]
        yield row


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--before", metavar="PROGRAM")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("command", nargs=argparse.REMAINDER, metavar="BENCHMARK ARGUMENTS")
    options = parser.parse_args()
    if not options.command or options.rounds < 1:
        parser.error("a benchmark and at least one round are needed")
    found, before = rounds(), rounds() if options.before else None
    for _ in range(options.rounds):
        if before is not None:
            before.add(benchmarks_of([options.before] + options.command[1:], parser))
        found.add(benchmarks_of(options.command, parser))
    heads = ["", "time", "rate", "limit", "its rate", "share"] + (["before", "times"] if before is not None else [])
    table = list(rows_of(found, before, parser))
    if not table:
        parser.error("no benchmark names a limit")
    print_table(heads, table)


main()
