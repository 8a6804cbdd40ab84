#!/usr/bin/env python3
"""Each way of a material to a renderer, on each kind of material: do the values arrive?

  gonio-papers run --markdown docs/results/renderers.md -- tests/python/test_renderer_paths.py

prints a table of the relative differences. The ways into Mitsuba need its variant llvm_ad_rgb.
"""

import functools
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import gonio
from surroundings import MEASUREMENTS, SOURCE, TOOL, random_pairs, table_of_formula

try:
    import drjit as dr
    import mitsuba as mi

    mi.set_variant("llvm_ad_rgb")
    dr.eval(mi.Float(1) + 1)  # fails without LLVM
    sys.path.insert(0, str(SOURCE / "examples" / "python"))
    import mitsuba_table  # noqa: F401
except (ImportError, RuntimeError):
    mi = None

GRID = (90, 90, 180)


# ---- the kinds of material ------------------------------------------------------------------------------------------


def with_negative_cells():
    """Green and blue are lower by an amount that grows with theta_h, as behind a dark signal that was too large."""
    table = table_of_formula("red-paint", "centre", shape=GRID)
    table.values[:, 1:] -= 0.05 * np.sin(table.angles()[:, :1]) ** 2
    assert (table.values < 0).mean() > 0.1
    return table


def with_needle():
    """A mirror-like highlight: GGX of slope .01 above a matt base."""
    table = table_of_formula("red-paint", "centre", shape=GRID)
    half = table.directions()[:, :3] + table.directions()[:, 3:]
    cosine = half[:, 2] / np.linalg.norm(half, axis=1)
    slope_squared = 0.01**2
    table.values[:] += (0.05 * slope_squared / np.pi / (cosine**2 * (slope_squared - 1) + 1) ** 2)[:, None]
    return table


def model_fit():
    return gonio.fit_model(gonio.formula_material("red-paint").tabulate(), "ggx").model


def reconstruction():
    return gonio.Estimator(gonio.read_prior()).fit(gonio.read_samples(MEASUREMENTS))


MATERIALS = {
    "values at lower corners": lambda: table_of_formula("gold-metal", "lower_corner", shape=GRID),
    "values at cell centres": lambda: table_of_formula("gold-metal", "centre", shape=GRID),
    "negative cells": with_negative_cells,
    "needle": with_needle,
    "model fit": model_fit,
    "reconstruction": reconstruction,
}


# ---- the ways to a renderer: what arrives of a BRDF at pairs of directions ------------------------------------------


def run_tool(*words):
    subprocess.run([TOOL, *map(str, words)], check=True, capture_output=True)


def by_merl(brdf, folder, wi, wo):
    gonio.write_merl(folder / "m.binary", brdf)
    return gonio.read_merl(folder / "m.binary")(wi, wo)


def by_rgl(brdf, folder, wi, wo):
    gonio.write_rgl(folder / "m.bsdf", brdf)
    return gonio.read_rgl(folder / "m.bsdf")(wi, wo)


def by_converted(extension, brdf, folder, wi, wo, *options):
    """Converts a MERL file by the tool, there and back."""
    gonio.write_merl(folder / "m.binary", brdf)
    run_tool("convert", folder / "m.binary", folder / f"m{extension}", *options)
    run_tool("convert", folder / f"m{extension}", folder / "back.binary")
    return gonio.read_merl(folder / "back.binary")(wi, wo)


def by_mitsuba(plug_in, brdf, folder, wi, wo):
    kind, write = {"gonio_table": (".binary", gonio.write_merl), "measured": (".bsdf", gonio.write_rgl)}[plug_in]
    write(folder / f"m{kind}", brdf)
    bsdf = mi.load_dict({"type": plug_in, "filename": str(folder / f"m{kind}")})
    surface = dr.zeros(mi.SurfaceInteraction3f, len(wi))
    surface.wi = mi.Vector3f(np.ascontiguousarray(wo.T, dtype=np.float32))
    value = bsdf.eval(mi.BSDFContext(), surface, mi.Vector3f(np.ascontiguousarray(wi.T, dtype=np.float32)))
    return np.array(value).T / wi[:, 2:]


WAYS = {".binary": by_merl, ".bsdf": by_rgl}
if TOOL:
    WAYS |= {
        ".bsdf, spectral": lambda *all: by_converted(".bsdf", *all, "--spectra"),
        ".mbsdf": functools.partial(by_converted, ".mbsdf"),
        ".npy, half": lambda *all: by_converted(".npy", *all, "--half"),
    }
if mi:
    WAYS |= {
        "Mitsuba, gonio_table": functools.partial(by_mitsuba, "gonio_table"),
        "Mitsuba, measured": functools.partial(by_mitsuba, "measured"),
    }


@functools.cache
def sent(material):
    """Returns the BRDF and, for 4,000 pairs up to 80 degrees, light, viewer and the value that a renderer should get."""
    wi, wo = random_pairs(4000, smallest_cosine=0.17)
    brdf = MATERIALS[material]()
    clipped = brdf
    if isinstance(brdf, gonio.Table):
        clipped = brdf.copy()
        clipped.values[:] = np.maximum(brdf.values, 0)  # renderers get no negative cell
    return brdf, wi, wo, np.maximum(clipped(wi, wo), 0)


def differences(material, way):
    """Returns the relative difference of each pair's value from the one that was sent, the largest of its channels."""
    brdf, wi, wo, expected = sent(material)
    with tempfile.TemporaryDirectory() as folder:
        arrived = np.maximum(WAYS[way](brdf, pathlib.Path(folder), wi, wo), 0)
    scale = np.maximum(expected.max(axis=1, keepdims=True), 1e-3)
    return (np.abs(arrived - expected) / scale).max(axis=1)


class RendererPathsTest(unittest.TestCase):
    # Limits of the median and of the 99th percentile. Values half a cell off have a median of 1.7 %.
    LIMITS = {
        ".binary": (3e-4, 6e-3),
        ".bsdf": (1e-3, 4e-2),
        ".bsdf, spectral": (2e-3, 4e-2),
        ".mbsdf": (6e-3, 8e-2),
        ".npy, half": (2e-3, 6e-3),
        "Mitsuba, gonio_table": (3e-4, 6e-3),
        "Mitsuba, measured": (1e-3, 4e-2),
    }

    def test_values_arrive(self):
        for material in MATERIALS:
            for way in WAYS:
                with self.subTest(material=material, way=way):
                    found = differences(material, way)
                    median, rare = self.LIMITS[way]
                    self.assertLess(np.median(found), median)
                    self.assertLess(np.quantile(found, 0.99), rare)


if __name__ == "__main__":
    print("Relative differences in %, the median (the 99th percentile).\n")
    print("| | " + " | ".join(WAYS) + " |\n|---|" + "---|" * len(WAYS))
    for name in MATERIALS:
        shares = [np.quantile(100 * differences(name, way), (0.5, 0.99)) for way in WAYS]
        print(f"| {name} | " + " | ".join(f"{median:.3f} ({rare:.2f})" for median, rare in shares) + " |", flush=True)
