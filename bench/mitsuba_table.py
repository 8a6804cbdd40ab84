#!/usr/bin/env python3
"""Compares the plug-in for Mitsuba 3 with Mitsuba's `measured` on RGL database materials, for docs/results/python.md:

  gonio-papers run --markdown docs/results/python.md -- bench/mitsuba_table.py satin_purple.bsdf paper_white.bsdf ...

Run it in an environment with the module and Mitsuba (`pip install mitsuba`).
"""
import argparse
import contextlib
import io
import pathlib
import sys
import tempfile
import time

import numpy as np

import drjit as dr
import mitsuba as mi

mi.set_variant("llvm_ad_rgb")
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "examples" / "python"))

import gonio  # noqa: E402
import mitsuba_table  # noqa: E402, F401
from mitsuba.chi2 import BSDFAdapter, ChiSquareTest, SphericalDomain  # noqa: E402

PAIRS = 1 << 20


def refused(file):
    """Returns how many of Mitsuba's chi-square tests of samples against the density fail at 1 %, for four directions
    and three seeds. At 0 degrees the test's cells, in equal steps of the cosine, are wider than the narrowest
    highlights, so the test would measure its own integration of the density."""
    count = 0
    for degrees in (20, 40, 60, 80):
        wi = [float(np.sin(np.radians(degrees))), 0.0, float(np.cos(np.radians(degrees)))]
        sample, density = BSDFAdapter("gonio_table", f'<string name="filename" value="{file}"/>', wi=wi)
        for seed in range(3):
            test = ChiSquareTest(domain=SphericalDomain(), sample_func=sample, pdf_func=density, sample_dim=3,
                                 sample_count=1000000, res=101, ires=16, seed=seed)
            with contextlib.redirect_stdout(io.StringIO()):
                test.run()
            count += test.p_value < 0.01
    return count


def seconds_of(work, runs=5):
    """Returns the minimum processor time of all cores, which other programs on the machine affect least."""
    work()  # compiles the kernel
    times = []
    for _ in range(runs):
        start = time.process_time()
        work()
        times.append(time.process_time() - start)
    return min(times)


def evaluate_and_sample(bsdf):
    """Returns millions per CPU second: of evaluated pairs, and of drawn directions."""
    sampler = mi.load_dict({"type": "independent"})
    sampler.seed(1, PAIRS)
    si = dr.zeros(mi.SurfaceInteraction3f, PAIRS)
    si.wi = mi.warp.square_to_cosine_hemisphere(sampler.next_2d())
    wo, one, two = mi.warp.square_to_cosine_hemisphere(sampler.next_2d()), sampler.next_1d(), sampler.next_2d()
    dr.eval(si, wo, one, two)
    context = mi.BSDFContext()

    def evaluate():
        dr.eval(bsdf.eval(context, si, wo))
        dr.sync_thread()

    def sample():
        drawn, weight = bsdf.sample(context, si, one, two)
        dr.eval(drawn.wo, drawn.pdf, weight)
        dr.sync_thread()

    return PAIRS / seconds_of(evaluate) / 1e6, PAIRS / seconds_of(sample) / 1e6


def sphere(bsdf):
    """Renders a sphere under a sky with a bright disc. Returns the image (256 samples a pixel) and the time for 64."""
    scene = mi.load_dict({
        "type": "scene",
        "integrator": {"type": "direct", "emitter_samples": 1, "bsdf_samples": 1},
        "sensor": {"type": "orthographic", "to_world": mi.ScalarTransform4f().look_at([0, 0, 4], [0, 0, 0], [0, 1, 0]),
                   "film": {"type": "hdrfilm", "width": 128, "height": 128, "rfilter": {"type": "box"}}},
        "sky": {"type": "constant", "radiance": 0.5},
        "lamp": {"type": "sphere", "center": [6, 6, 8], "radius": 1.5,
                 "emitter": {"type": "area", "radiance": {"type": "rgb", "value": 20}}},
        "ball": {"type": "sphere", "bsdf": bsdf},
    })
    image = np.array(mi.render(scene, spp=256, seed=7))

    def draw():
        dr.eval(mi.render(scene, spp=64, seed=1))
        dr.sync_thread()

    return image, seconds_of(draw, 3)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("materials", nargs="+", type=pathlib.Path, help="files of the RGL database (.bsdf)")
    given = parser.parse_args()
    print(f"Mitsuba {mi.__version__}, {mi.variant()}.\n")
    print("| material | chi-square tests refused, of 12 | evaluated, million a CPU second | `measured` | drawn, million "
          "a CPU second | `measured` | sphere, CPU s | `measured` | pixels differ by, mean |\n|---|---|---|---|---|---|---|---|---|")
    y, x = np.mgrid[:128, :128]
    disc = np.hypot(x - 63.5, y - 63.5) < 60
    with tempfile.TemporaryDirectory() as folder:
        for file in given.materials:
            table = str(pathlib.Path(folder) / (file.stem + ".binary"))
            gonio.write_merl(table, gonio.read_rgl(file))
            ours = mi.load_dict({"type": "gonio_table", "filename": table})
            theirs = mi.load_dict({"type": "measured", "filename": str(file)})
            (our_image, our_time), (their_image, their_time) = sphere(ours), sphere(theirs)
            difference = np.abs(our_image - their_image)[disc].mean() / their_image[disc].mean()
            (evaluated, drawn), (evaluated_by_it, drawn_by_it) = evaluate_and_sample(ours), evaluate_and_sample(theirs)
            print(f"| {file.stem} | {refused(table)} | {evaluated:.1f} | {evaluated_by_it:.1f} | {drawn:.1f} | "
                  f"{drawn_by_it:.1f} | {our_time:.2f} | {their_time:.2f} | {100 * difference:.1f} % |", flush=True)


if __name__ == "__main__":
    main()
