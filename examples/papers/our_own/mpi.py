#!/usr/bin/env python3
"""Measures gonio-mpi and gonio-papers-mpi with 1, 2 and 4 ranks on this machine: bytes, processor time, traffic and
killed ranks. Estimates the time on 16 and 64 machines from these counts:
  gonio-papers run --markdown docs/results/mpi.md -- examples/papers/our_own/mpi.py MATERIALS [NETWORKS]
MATERIALS is a folder of the RGL database's .bsdf files. NETWORKS is a file of networks (.npy); without it, there is no
row of gonio-papers-mpi. GONIO_BIN is the folder of the programs (default: those on the path), SIZE the number of texels
each way of the sample for gonio svbrdf, KILLS the number of killed ranks. Needs numpy, and mpirun of Open MPI."""

import filecmp
import json
import os
import pathlib
import random
import re
import signal
import subprocess
import sys
import tempfile
import time

import numpy as np

FOLDER = os.environ.get("GONIO_BIN", "")
SIZE = int(os.environ.get("SIZE", "2048"))
KILLS = int(os.environ.get("KILLS", "6"))
RANKS = (1, 2, 4)
IMAGES, COMPONENTS, CELLS = 20, 60, 1096216
NETWORK = 10e9 / 8  # bytes a second
LATENCY = 2e-6  # seconds a message
# For Open MPI: as root in a container, and with more ranks than cores.
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
               "OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_hwloc_base_binding_policy": "none"}
COST = re.compile(r"rank (\d+) sent (\d+) messages, (\d+) bytes; ([\d.]+) s of processor time, ([\d.]+) s of it in MPI")


def program(name):
    return str(pathlib.Path(FOLDER) / name) if FOLDER else name


def in_ranks(ranks, words, tool="gonio"):
    return ["mpirun", "-n", str(ranks), program(tool + "-mpi"), *words]


def write_images(folder):
    """Writes images of a sample without structure: the work for a texel does not depend on its values."""
    generator = np.random.default_rng(1)
    images = []
    for i in range(IMAGES):
        values = generator.uniform(0.01, 0.4, (SIZE, SIZE, 3)).astype(np.float32)
        np.save(folder / f"image-{i}.npy", values)
        images.append({"image": f"image-{i}.npy", "theta_h": float(generator.uniform(0, 40)),
                       "theta_d": float(generator.uniform(0, 50)), "phi_d": float(generator.uniform(0, 180))})
    (folder / "images.json").write_text(json.dumps({"quantity": "brdf", "images": images}))


class Measured:
    """The cost of a command with 1, 2 and 4 ranks: seconds of wall time, costs of each rank, and whether all runs wrote
    the same bytes into the file that an option names."""

    def __init__(self, name, words, folder, tool="gonio", option="-o"):
        self.name = name
        end = words.index(option) + 1
        alone = folder / ("alone" + pathlib.Path(words[end]).suffix)
        subprocess.run([program(tool), *words[:end], str(alone), *words[end + 1:]], check=True, cwd=folder,
                       stdout=subprocess.DEVNULL)
        self.seconds, self.costs, self.same = {}, {}, True
        for ranks in RANKS:
            (folder / words[end]).unlink(missing_ok=True)  # a run would continue from this file
            start = time.monotonic()
            said = subprocess.run(in_ranks(ranks, [*words, "--traffic"], tool), check=True, cwd=folder, env=ENVIRONMENT,
                                  stdout=subprocess.PIPE, text=True).stdout
            self.seconds[ranks] = time.monotonic() - start
            self.costs[ranks] = [tuple(map(float, found)) for found in COST.findall(said)]
            self.same = self.same and filecmp.cmp(alone, folder / words[end], shallow=False)
        self.size = alone.stat().st_size

    def work(self, ranks):
        """Returns the processor seconds of the busiest rank, without those in MPI."""
        return max(cost[3] - cost[4] for cost in self.costs[ranks])

    def efficiency(self, ranks):
        return self.work(1) / (ranks * self.work(ranks))

    def bytes(self, ranks):
        return sum(cost[2] for cost in self.costs[ranks])

    def messages(self, ranks):
        return sum(cost[1] for cost in self.costs[ranks])

    def parts(self):
        """Fits work = alone + shared / ranks to the measured seconds, and returns both terms."""
        shared, alone = np.polyfit([1 / ranks for ranks in RANKS], [self.work(ranks) for ranks in RANKS], 1)
        return max(alone, 0.0), shared

    def print_rows(self):
        for ranks in RANKS:
            print(f"| {self.name} | {ranks} | {self.seconds[ranks]:.1f} s | "
                  f"{self.seconds[1] / self.seconds[ranks]:.2f} | {self.work(ranks):.1f} s | "
                  f"{100 * self.efficiency(ranks):.0f} % | {self.messages(ranks):.0f} | "
                  f"{self.bytes(ranks) / 1e6:.3f} MB | {'yes' if self.same else 'NO'} |")


def process_of_rank(mpirun, rank):
    """Returns the process of a rank that mpirun started, or None."""
    for child in pathlib.Path(f"/proc/{mpirun}/task/{mpirun}/children").read_text().split():
        try:
            words = pathlib.Path(f"/proc/{child}/environ").read_bytes().split(b"\0")
        except OSError:
            continue
        if f"OMPI_COMM_WORLD_RANK={rank}".encode() in words:
            return int(child)
    return None


def print_kills(words, expected, folder):
    """Kills one of two ranks at random moments, runs the command again with other numbers of ranks, and compares."""
    generator = random.Random(1)
    output, with_bands, same, killed = folder / "again.gsv", 0, True, 0
    part = folder / "again.gsv.part"
    while killed < KILLS:
        start = time.monotonic()
        job = subprocess.Popen(in_ranks(2, words), cwd=folder, env=ENVIRONMENT, stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL)
        wait = generator.uniform(0.4, 3.0)
        while time.monotonic() - start < wait and job.poll() is None:
            time.sleep(0.01)
        victim = process_of_rank(job.pid, killed % 2) if job.poll() is None else None
        if victim:
            os.kill(victim, signal.SIGKILL)
        ended = job.wait()
        if victim and ended != 0:
            killed += 1
            with_bands += part.exists() and part.stat().st_size > 65536
        else:
            output.unlink(missing_ok=True)
        if killed % 2 == 0 or killed == KILLS:  # after every second kill, let the job finish
            subprocess.run(in_ranks(1 + killed % 3, words), check=True, cwd=folder, env=ENVIRONMENT,
                           stdout=subprocess.DEVNULL)
            same = same and filecmp.cmp(expected, output, shallow=False)
            output.unlink()
    print(f"\nOne of two ranks killed {KILLS} times at random moments, {with_bands} times with bands in the file, and "
          f"the command given again, to two ranks and then to one, two or three: "
          f"{'the same bytes' if same else 'OTHER BYTES'}.")


def print_extrapolated(svbrdf, design, learn, materials):
    """Prints estimated seconds on N machines: each one's own work, its share, and the busiest link's traffic."""
    columns, sweeps = 3 * materials, design.bytes(2) / 32
    exchanged, kept = 12.0 * materials * CELLS, CELLS * (4.0 * min(COMPONENTS, columns - 1) + 12.0)
    gram = 8.0 * columns ** 2

    def map_share(n):
        """Returns the share of the map that ranks other than 0 compute: rank 0 computes each n-th band."""
        bands = -(-SIZE // max(1, 16384 // SIZE))
        return (bands - -(-bands // n)) / bands

    def learn_bytes(n):
        """Returns all bytes sent: rows of tables, the prior's rows to rank 0, Gram matrices up and down the tree."""
        return (exchanged + kept) * (1 - 1 / n) + 2 * gram * (n - 1)

    print(f"\n| counted beside reckoned, MB | 2 ranks | 4 ranks |\n|---|---|---|")
    print(f"| svbrdf: the map's bytes of the ranks but the first | {svbrdf.bytes(2) / 1e6:.2f}, "
          f"{map_share(2) * svbrdf.size / 1e6:.2f} | {svbrdf.bytes(4) / 1e6:.2f}, "
          f"{map_share(4) * svbrdf.size / 1e6:.2f} |")
    print(f"| design: 32 bytes a sweep and rank but the first | {design.bytes(2) / 1e6:.4f}, {32e-6 * sweeps:.4f} | "
          f"{design.bytes(4) / 1e6:.4f}, {96e-6 * sweeps:.4f} |")
    print(f"| learn: rows exchanged, rows kept, Gram matrices | {learn.bytes(2) / 1e6:.1f}, "
          f"{learn_bytes(2) / 1e6:.1f} | {learn.bytes(4) / 1e6:.1f}, {learn_bytes(4) / 1e6:.1f} |")
    print(f"\n| reckoned, {NETWORK * 8e-9:.0f} Gbit/s and {LATENCY * 1e6:.0f} us a message | machines | work | "
          "network | speed |")
    print("|---|---|---|---|---|")

    def row(measured, n, network, times=1):
        alone, shared = measured.parts()
        work, network = alone + times * shared / n, times * network
        name = measured.name + (f", {times} times the texels" if times > 1 else "")
        speed = (alone + times * shared) / (work + network)
        print(f"| {name} | {n} | {work:.2f} s | {network:.3f} s | {speed:.1f} times |")

    for n in (16, 64):
        row(svbrdf, n, svbrdf.size * (1 - 1 / n) / NETWORK)
    for n in (16, 64):
        row(svbrdf, n, svbrdf.size * (1 - 1 / n) / NETWORK, 16)
    for n in (16, 64):
        row(design, n, sweeps * (n - 1 + np.log2(n)) * LATENCY)
    for n in (16, 64):
        received = (exchanged / n + kept) * (1 - 1 / n) + 2 * np.log2(n) * gram  # by rank 0
        row(learn, n, received / NETWORK + materials * LATENCY)


def main():
    materials = pathlib.Path(sys.argv[1])
    count = len(list(materials.glob("*.bsdf")))
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_images(folder)
        svbrdf = Measured("svbrdf", ["svbrdf", "images.json", "-o", "map.gsv", "--threads", "1"], folder)
        design = Measured("design", ["design", "-n", "6", "-o", "six.csv", "--threads", "1"], folder)
        learn = Measured("learn", ["learn", "--rgl", str(materials.resolve()), "--components", str(COMPONENTS), "-o",
                                   "my.prior", "--threads", "1"], folder)
        print(f"{SIZE} x {SIZE} texels and {IMAGES} images; 6 directions for the prior that ships; {count} materials "
              f"of the RGL database, {COMPONENTS} components. One thread a rank.\n")
        print("| command | ranks | time | times as fast as one | work of the busiest rank | efficiency | messages | "
              "sent | bytes of gonio |")
        print("|---|---|---|---|---|---|---|---|---|")
        for each in (svbrdf, design, learn):
            each.print_rows()
        if len(sys.argv) > 2:
            words = ["real-methods", "--networks", str(pathlib.Path(sys.argv[2]).resolve()), "--materials",
                     str(materials.resolve()), "--random", "20", "100", "--repetitions", "1", "--threads", "1",
                     "--state", "methods.state"]
            Measured("papers real-methods", words, folder, "gonio-papers", "--state").print_rows()
        print_kills(["svbrdf", "images.json", "-o", "again.gsv", "--threads", "1"], folder / "alone.gsv", folder)
        print_extrapolated(svbrdf, design, learn, count)


main()
