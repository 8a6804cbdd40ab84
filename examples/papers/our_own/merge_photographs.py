#!/usr/bin/env python3
"""Measures the errors of `gonio lab merge` on simulated photographs, and those of pfstools if it is installed:
  gonio-papers run --markdown docs/results/merged-photographs.md -- examples/papers/our_own/merge_photographs.py SCENE.hdr
GONIO is the tool (default: gonio), SEEDS the number of brackets of each camera (default: 3). Needs only Python."""

import array
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

TOOL = os.environ.get("GONIO", "gonio")
SEEDS = int(os.environ.get("SEEDS", "3"))


def run(*words):
    return subprocess.run([str(word) for word in words], check=True, capture_output=True, text=True).stdout


def floats_of(path):
    """Returns the elements of an .npy file of float32."""
    content = path.read_bytes()
    start = 10 + int.from_bytes(content[8:10], "little")
    return array.array("f", content[start:])


def median(values):
    return sorted(values)[len(values) // 2]


def usable(values, deviations, truth):
    """Returns the indices of the values above twice their deviation that are neither saturated nor hot."""
    return [i for i, (v, d, t) in enumerate(zip(values, deviations, truth)) if v > 2 * d and math.isfinite(d) and t > 0]


def judge(values, truth, known, deviations=None, to_scale=False):
    """Returns the per cent of 95 % intervals that contain the truth (nan without deviations), and the median and 95th
    percentile of the relative errors in per cent. With `to_scale`, first scales each channel to the truth."""
    errors, held = [], 0
    for channel in range(3):
        numbers = [i for i in known if i % 3 == channel]
        scale = median([truth[i] / values[i] if values[i] > 0 else math.inf for i in numbers]) if to_scale else 1.0
        for i in numbers:
            off = abs(scale * values[i] - truth[i])
            errors.append(off / truth[i])
            held += deviations is not None and off < 1.96 * scale * deviations[i]
    errors.sort()
    share = 100 * held / len(errors) if deviations is not None else math.nan
    return share, 100 * errors[len(errors) // 2], 100 * errors[len(errors) * 95 // 100]


def merge(folder, *options):
    run(TOOL, "lab", "merge", folder / "light", "-o", folder / "merged.npy", "--deviation", folder / "deviation.npy",
        *options)
    return floats_of(folder / "merged.npy"), floats_of(folder / "deviation.npy")


def taken_off_level(source, target, level):
    """Writes a 16-bit PPM file without the dark level, which pfstools does not know."""
    content = source.read_bytes()
    header = re.match(rb"P6\s(\d+)\s(\d+)\s(\d+)\s", content)
    largest = int(header[3])
    counts = array.array("H", content[header.end():])
    counts.byteswap()
    lifted = array.array("H", (max(0, count - level) * 65535 // (largest - level) for count in counts))
    lifted.byteswap()
    target.write_bytes(b"P6\n%s %s\n65535\n" % (header[1], header[2]) + lifted.tobytes())


def merged_by_pfstools(folder, level):
    """Returns the radiance that pfshdrcalibrate merges from the photographs, with the correct linear response."""
    lines = []
    for source in sorted((folder / "light").iterdir()):
        target = folder / (source.stem + "_above.ppm")
        taken_off_level(source, target, level)
        seconds = float(re.search(r"_([0-9.e-]+)s$", source.stem)[1])
        lines.append(f"{target} {1 / seconds} 1 100 0\n")
    (folder / "list.hdrgen").write_text("".join(lines))
    stream = subprocess.run(f"pfsinhdrgen {folder}/list.hdrgen | pfshdrcalibrate -c none -r linear -b 16",
                            shell=True, check=True, capture_output=True).stdout
    # Two lines of words and sizes, lists of tags, then the planes X, Y and Z.
    columns, rows = map(int, stream.split(b"\n")[1].split())
    size = rows * columns
    planes = array.array("f", stream[stream.index(b"ENDH") + 4:])
    x, y, z = planes[:size], planes[size:2 * size], planes[2 * size:3 * size]
    values = array.array("f", bytes(12 * size))
    for channel, (a, b, c) in enumerate(((3.240708, -1.537259, -0.498570), (-0.969257, 1.875995, 0.041555),
                                         (0.055636, -0.203996, 1.057069))):
        values[channel::3] = array.array("f", (a * i + b * j + c * k for i, j, k in zip(x, y, z)))
    return values


def print_row(name, results):
    shares = [share for share, _, _ in results]
    means = [sum(column) / len(results) for column in zip(*results)]
    held = "" if math.isnan(means[0]) else f"{means[0]:.1f} ({min(shares):.1f} to {max(shares):.1f})"
    print(f"| {name} | {held} | {means[1]:.2f} | {means[2]:.2f} |")


def measure(scene, camera, seed, folder, rows):
    """Photographs a scene, merges the photographs by each method, and adds the errors to the rows."""
    def add(row, *judged, **how):
        rows.setdefault(row, []).append(judge(*judged, **how))

    printed = run(TOOL, "lab", "photograph", scene, "--camera", camera, "--seed", seed, "-o", folder)
    noise = printed[printed.index("--read-noise"):].split()
    truth = floats_of(folder / "truth.npy")
    known = {"linear": ("--gamma", 1, "--dark", folder / "dark"), "gamma": ("--gamma", 2.2), "s-shaped": None}[camera]
    if known:
        values, deviations = merge(folder, *noise, *known)
        numbers = usable(values, deviations, truth)
        add(f"{camera}, response known", values, truth, numbers, deviations)
        if camera == "linear" and shutil.which("pfshdrcalibrate"):
            add("the same, to scale", values, truth, numbers, deviations, to_scale=True)
            add("pfstools, of the same pixels, to scale", merged_by_pfstools(folder, 64), truth, numbers, to_scale=True)
    values, deviations = merge(folder, *noise, *(("--dark-level", 64) if camera == "linear" else ()))
    add(f"{camera}, response estimated, to scale", values, truth, usable(values, deviations, truth), deviations,
        to_scale=True)


def main():
    rows = {}
    for camera in ("linear", "gamma", "s-shaped"):
        for seed in range(1, SEEDS + 1):
            with tempfile.TemporaryDirectory() as name:
                measure(sys.argv[1], camera, seed, pathlib.Path(name), rows)
    print("| camera | 95 % intervals hold, % (least, most) | median error, % | 95th percentile, % |")
    print("|---|---|---|---|")
    for name, results in rows.items():
        print_row(name, results)


main()
