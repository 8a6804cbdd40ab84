#!/usr/bin/env python3
"""Compares Mitsuba 3's spheres of measured tables, and of reconstructions from 20 samples, with gonio's.

  gonio-papers run --markdown docs/results/renderers.md -- examples/papers/our_own/mitsuba_spheres.py \\
    --environment grace_probe_latlong.hdr --priors FOLDER -o spheres.png satin_purple.binary ...

Mitsuba renders the table by the plug-in examples/python/mitsuba_table.py and the file that `gonio convert` makes for its
`measured`. FOLDER has a prior for each material, NAME.prior, that was learned without the material's family. Needs `pip
install mitsuba` and the module gonio.
"""

import argparse
import functools
import pathlib
import sys
import tempfile

import drjit as dr
import mitsuba as mi
import numpy as np

import gonio
from seen_spheres import LIGHTS, SIZE, WHITE, GonioSphere, delta_e, luminance

mi.set_variant("llvm_ad_rgb")
sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "python"))
import mitsuba_table  # noqa: F401


def rendered(bsdf, light, spp, seed):
    scene = {"type": "scene", "integrator": {"type": "direct"}, "sphere": {"type": "sphere", "bsdf": bsdf},
             "sensor": {"type": "orthographic",
                        "to_world": mi.ScalarTransform4f().look_at(origin=[0, 0, 4], target=[0, 0, 0], up=[0, 1, 0]),
                        "film": {"type": "hdrfilm", "width": SIZE, "height": SIZE, "rfilter": {"type": "box"}}}}
    scene["light"] = light
    return np.array(mi.render(mi.load_dict(scene), spp=spp, seed=seed))


class Lighting:
    """Lights for Mitsuba, and gonio's rendering under the same lights."""

    def __init__(self, lights, spp, by_gonio):
        self.lights, self.spp, self.by_gonio, self.exposure = lights, spp, GonioSphere(by_gonio), 1.0
        white = self.by_mitsuba({"type": "diffuse", "reflectance": {"type": "rgb", "value": 1.0}})
        self.exposure = WHITE / luminance(white)

    def by_mitsuba(self, bsdf, seed=1):
        # Render one light at a time: of several, Mitsuba would choose one at random.
        return self.exposure * sum(rendered(bsdf, light, self.spp, seed) for light in self.lights)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("materials", nargs="+", type=pathlib.Path, help="MERL files")
    parser.add_argument("--environment", required=True, help="latitude-longitude image (.hdr)")
    parser.add_argument("--priors", required=True, type=pathlib.Path)
    parser.add_argument("-o", "--output", required=True, help="picture of all spheres (.png)")
    arguments = parser.parse_args()
    environment = gonio.read_hdr(arguments.environment)
    # The middle of gonio's image is behind the sphere, the middle of Mitsuba's behind the camera.
    bitmap = mi.Bitmap(np.ascontiguousarray(np.roll(environment, environment.shape[1] // 2, axis=1)))
    lightings = {
        "two lights": Lighting([{"type": "directional", "direction": to, "irradiance": 1.0} for to in LIGHTS], 256,
                               gonio.render_sphere),
        "environment": Lighting([{"type": "envmap", "bitmap": bitmap}], 4096,
                                functools.partial(gonio.render_sphere_in, environment=environment, quality=128)),
    }
    print(f"Mitsuba {mi.__version__}, {mi.variant()}.\n")
    heads = [f"{what}, {name}" for name in lightings for what in ("plug-in", "`measured`", "`measured`, another seed")]
    print("Delta E, the median of the pixels and the 99th percentile.\n")
    print("| | " + " | ".join(heads) + " |\n|---|" + "---|" * len(heads))
    pictures = []
    with tempfile.TemporaryDirectory() as folder:
        for file in arguments.materials:
            truth = gonio.read_merl(file)
            prior = gonio.read_prior(arguments.priors / f"{file.stem}.prior")
            directions = gonio.design(prior, 20).directions
            samples = gonio.Samples(directions, truth(directions[:, :3], directions[:, 3:]))
            estimate = gonio.reconstruct(samples, prior=prior).table
            shown = []
            for name, table in ((file.stem, truth), (f"{file.stem} of 20 samples", estimate)):
                merl, rgl = (str(pathlib.Path(folder) / f"paint.{kind}") for kind in ("binary", "bsdf"))
                gonio.write_merl(merl, table)
                gonio.write_rgl(rgl, table)
                row = [name]
                for lighting in lightings.values():
                    ours = lighting.by_gonio(table)
                    shown.append(ours)
                    by_table = lighting.by_mitsuba({"type": "gonio_table", "filename": merl})
                    by_rgl, again = (lighting.by_mitsuba({"type": "measured", "filename": rgl}, seed) for seed in (1, 2))
                    shown += [by_table, by_rgl]
                    for pair in ((ours, by_table), (ours, by_rgl), (by_rgl, again)):
                        differences = delta_e(*pair)
                        row.append(f"{np.median(differences):.2f}, {np.quantile(differences, 0.99):.2f}")
                print("| " + " | ".join(row) + " |", flush=True)
            pictures.append(np.concatenate(shown, axis=1))
    gonio.write_png(arguments.output, np.ascontiguousarray(np.concatenate(pictures), dtype=np.float32))
    dr.sync_thread()


if __name__ == "__main__":
    main()
