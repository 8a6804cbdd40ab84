#!/usr/bin/env python3
"""Compares Mitsuba 3's spheres with the parameters that `gonio fit` writes with gonio's of the fit and of the table:
  gonio-papers run --markdown docs/results/renderers.md -- examples/papers/our_own/mitsuba_fits.py \\
    grace_probe_latlong.hdr cardboard.binary.gz satin_purple.binary.gz
The arguments are an environment and tables; three materials by formulas come with gonio. mitsuba_measured.py explains
GONIO and the requirements."""

import json
import math
import pathlib
import sys
import tempfile

from mitsuba_measured import TOOL, evaluate, mi, np, one_direction, run, sphere_difference


def as_principled(gltf):
    """Returns a glTF 2.0 material as Mitsuba's `principled` (Disney's BSDF), the nearest that Mitsuba ships."""
    material = json.loads(gltf.read_text())["materials"][0]
    rough = material["pbrMetallicRoughness"]
    extensions = material.get("extensions", {})
    # Use the brightness of the specular tint, which is a colour in glTF and a share in Disney's BSDF.
    tint = extensions.get("KHR_materials_specular", {}).get("specularColorFactor", [1.0])
    principled = {"type": "principled", "base_color": {"type": "rgb", "value": rough["baseColorFactor"][:3]},
                  "metallic": rough["metallicFactor"], "roughness": rough["roughnessFactor"]}
    if not rough["metallicFactor"]:
        index = extensions.get("KHR_materials_ior", {}).get("ior", 1.5)
        scale = extensions.get("KHR_materials_specular", {}).get("specularFactor", 1.0) * max(tint)
        # `specular` is 0.5 at 4 % reflectance.
        principled["specular"] = min(scale * ((index - 1) / (index + 1)) ** 2 / 0.08, 1.0)
    return principled


def albedo(bsdf, degrees, count=1 << 18):
    """Returns the directional albedo in red, green and blue, from cosine-weighted directions."""
    random = np.random.default_rng(3)
    radius, phi = np.sqrt(random.random(count)), 2 * math.pi * random.random(count)
    light = radius * np.cos(phi), radius * np.sin(phi), np.sqrt(np.maximum(1 - radius**2, 1e-6))
    viewer = tuple(np.full(count, c) for c in one_direction(degrees))
    return math.pi * evaluate(bsdf, viewer, light).mean(axis=0)


def compare(name, source, environment, scratch):
    """Prints a row of the table: the differences of Mitsuba's renderings with the parameters from the fit, and from the
    material."""
    table, fitted, xml, gltf = (scratch / f"{name}{end}" for end in (".binary", "_fit.binary", ".xml", ".gltf"))
    run(TOOL, *source, table)
    run(TOOL, "fit", table, "--model", "ggx", "--cell-weights", "cosine", "-o", fitted, "--mitsuba", xml,
        "--gltf", gltf)
    energy = json.loads(run(TOOL, "properties", fitted, "--json"))["energy"]["by_angle"]
    by_angle = {round(each["theta_i"]): np.array(each["albedo"]) for each in energy}
    own = {"type": "measured", "filename": str(scratch / "own.bsdf")}
    run(TOOL, "convert", table, scratch / "own.bsdf")
    text = xml.read_text()
    kind = text.split('"')[1]
    rough = mi.load_string(text.replace("<bsdf", '<bsdf version="3.0.0"', 1))
    off = max(np.abs(albedo(rough, angle) / by_angle[angle] - 1).max() for angle in (0, 20, 40, 60))
    delta = [sphere_difference(truth, bsdf, environment, scratch)
             for bsdf in (rough, mi.load_dict(as_principled(gltf))) for truth in (fitted, table)]
    best = sphere_difference(table, own, environment, scratch)
    print(f"| {name} | {kind} | {100 * off:.1f} | " + " | ".join(f"{each:.2f}" for each in (*delta, best)) + " |",
          flush=True)


def main():
    environment, *tables = sys.argv[1:]
    sources = [(name, ("expand", "--formula", name, "-o")) for name in ("red-paint", "gold-metal", "blue-rubber")]
    sources += [(pathlib.Path(table).name.split(".")[0], ("convert", table)) for table in tables]
    print(f"Mitsuba {mi.__version__}, variant {mi.variant()}.\n")
    print("| material | `--mitsuba` writes | albedo to 60, % | Delta E to the fit | to the material | principled to the "
          "fit | to the material | `.bsdf` to the material |")
    print("|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as name:
        for source in sources:
            compare(*source, environment, pathlib.Path(name))


if __name__ == "__main__":
    main()
