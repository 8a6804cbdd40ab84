#!/usr/bin/env python3
"""Estimates a BRDF from one image: fits the weights of a prior with Mitsuba's derivatives of the rendered image.

    python inverse_rendering.py paint.binary --prior materials-without-paint.prior -o paint.png

The given image is rendered from `paint.binary`: a sphere under four lights and a grey sky. The sphere's BRDF starts as
the prior's mean material. Adam minimises the squared difference of the images plus `--penalty` times the squared
weights. The program prints a table of errors and draws the image, the estimate before and after, and the error over the
steps. It needs `pip install mitsuba matplotlib`.
"""

import argparse
import time

import drjit as dr
import matplotlib.pyplot as plt
import mitsuba as mi
import numpy as np

mi.set_variant("llvm_ad_rgb")

import gonio
import mitsuba_prior  # noqa: F401
import mitsuba_table  # noqa: F401

LIGHTS = [(0.3, 0.2, -1.0), (-1.0, 0.1, -0.4), (0.4, -1.0, -0.2), (0.9, 0.3, 0.5)]  # the light's directions of travel


def scene_of(bsdf, size):
    scene = {
        "type": "scene",
        "integrator": {"type": "direct", "emitter_samples": 1, "bsdf_samples": 1},
        "sensor": {
            "type": "orthographic",
            "to_world": mi.ScalarTransform4f().look_at(origin=[0, 0, 4], target=[0, 0, 0], up=[0, 1, 0]),
            "film": {"type": "hdrfilm", "width": size, "height": size, "rfilter": {"type": "box"}},
        },
        "sphere": {"type": "sphere", "bsdf": bsdf},
        "sky": {"type": "constant", "radiance": 0.1},
    }
    for i, direction in enumerate(LIGHTS):
        scene[f"light{i}"] = {"type": "directional", "direction": direction, "irradiance": 1.0}
    return mi.load_dict(scene)


def error_of(prior, weights, truth):
    """Returns the mean Delta E of a sphere, in an environment other than the image's light."""
    return gonio.compare(prior.brdf(weights), truth)["delta_e_env"]


def display(image):
    return np.clip(np.array(image), 0, 1) ** (1 / 2.2)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("truth", help="MERL file of the material")
    parser.add_argument("--prior", help="prior learned without the material (default: the prior that ships with gonio)")
    parser.add_argument("--components", type=int, default=20, help="number of the prior's components to fit")
    parser.add_argument("--size", type=int, default=96, help="width and height of the image in pixels")
    parser.add_argument("--samples", type=int, default=16, help="samples per pixel in each step")
    parser.add_argument("--steps", type=int, default=300, help="number of steps")
    parser.add_argument("--rate", type=float, default=0.005, help="learning rate of Adam")
    parser.add_argument("--penalty", type=float, default=3.0, help="factor of the mean squared weight in the loss")
    parser.add_argument("-o", "--output", required=True, help="image to write")
    arguments = parser.parse_args()

    truth, prior = gonio.read_merl(arguments.truth), gonio.read_prior(arguments.prior)
    wanted = mi.render(scene_of({"type": "gonio_table", "filename": arguments.truth}, arguments.size), spp=256)
    bsdf = {"type": "gonio_prior", "components": arguments.components}
    if arguments.prior:
        bsdf["prior"] = arguments.prior
    scene = scene_of(bsdf, arguments.size)
    parameters = mi.traverse(scene)
    key = "sphere.bsdf.weights"
    adam = mi.ad.Adam(lr=arguments.rate)
    adam[key] = parameters[key]
    before = mi.render(scene, spp=256)
    errors, spent = [], 0.0
    print("| steps | seconds | mean Delta E of spheres |\n|---|---|---|")
    for step in range(arguments.steps + 1):
        if step in (0, 3, 10, 30) or step % 100 == 0:
            weights = np.array(adam[key]).reshape(-1, 3)
            errors.append((step, spent, error_of(prior, weights, truth)))
            print(f"| {step} | {spent:.1f} | {errors[-1][2]:.2f} |", flush=True)
        begin = time.perf_counter()
        parameters.update(adam)
        image = mi.render(scene, parameters, spp=arguments.samples, seed=step)
        # Relative difference of bright pixels, absolute difference of dark ones.
        difference = (image - wanted) / (wanted + 0.05)
        loss = dr.mean(dr.square(difference), axis=None) + arguments.penalty * dr.mean(dr.square(adam[key]))
        dr.backward(loss)
        adam.step()
        spent += time.perf_counter() - begin

    figure, axes = plt.subplots(1, 4, figsize=(12, 3))
    for axis, (name, shown) in zip(axes, {"image": wanted, "mean material": before,
                                          f"after {arguments.steps} steps": mi.render(scene, spp=256)}.items()):
        axis.imshow(display(shown))
        axis.set_title(name)
        axis.axis("off")
    axes[3].plot(*zip(*[(step, error) for step, _, error in errors]), marker=".")
    axes[3].set(xlabel="steps", ylabel="mean ΔE of spheres", ylim=(0, None))
    figure.tight_layout()
    figure.savefig(arguments.output, dpi=100)


if __name__ == "__main__":
    main()
