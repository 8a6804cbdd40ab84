#!/usr/bin/env python3
"""Compares Mitsuba 3's values and spheres from the .bsdf files that gonio writes with gonio's of the same materials:
  gonio-papers run --markdown docs/results/renderers.md -- examples/papers/our_own/mitsuba_measured.py \\
    grace_probe_latlong.hdr rgl-bsdf cardboard.binary.gz satin_purple.binary.gz
  gonio-papers run --markdown docs/results/renderers.md -- examples/papers/our_own/mitsuba_measured.py --spectra
The arguments are an environment, a folder of RGL materials and tables; three materials by formulas come with gonio.
GONIO is the tool (default: gonio). Needs `pip install mitsuba numpy`, and LLVM's library for Mitsuba's variants."""

import contextlib
import io
import json
import os
import pathlib
import subprocess
import sys
import tempfile

TOOL = os.environ.get("GONIO", "gonio")
ANGLES = (0, 20, 40, 60, 80)

try:
    import mitsuba as mi
    import numpy as np

    mi.set_variant("llvm_ad_spectral" if "--spectra" in sys.argv else "llvm_ad_rgb")
    import drjit as dr
    from mitsuba.chi2 import BSDFAdapter, ChiSquareTest, SphericalDomain
except ImportError as reason:
    print(f"Skipped: {reason}. In a virtual environment: `pip install mitsuba numpy`.")
    sys.exit(0)


def run(*words):
    return subprocess.run([str(word) for word in words], check=True, capture_output=True, text=True).stdout


def measured(path):
    return mi.load_dict({"type": "measured", "filename": str(path)})


def direction(theta, phi):
    return np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)


def one_direction(degrees):
    return [float(c) for c in direction(np.radians(degrees), 0.3)]


def directions_of(theta_h, theta_d, phi_d):
    """Returns the pair of directions with these half and difference angles, and the half vector in the plane y = 0."""
    x, y, z = direction(theta_d, phi_d)
    sine, cosine = np.sin(theta_h), np.cos(theta_h)
    towards = lambda a, b, c: (cosine * a + sine * c, b, cosine * c - sine * a)
    return towards(x, y, z), towards(-x, -y, z)


def evaluate(bsdf, viewer, light, wavelengths=None):
    """Returns f in sr^-1 of many pairs: (pairs, channels)."""
    si = dr.zeros(mi.SurfaceInteraction3f, len(viewer[0]))
    if wavelengths is not None:
        si.wavelengths = mi.Spectrum(mi.Float(wavelengths))
    si.wi = mi.Vector3f(*(mi.Float(c.astype(np.float32)) for c in viewer))
    towards = mi.Vector3f(*(mi.Float(c.astype(np.float32)) for c in light))
    return np.array(bsdf.eval(mi.BSDFContext(), si, towards)).T / light[2][:, None]


def drawn_cells(table, count, least_cosine):
    """Draws cells of a table, uniformly in direction. Returns their pairs of directions and their values."""
    extents = table.shape[:3]
    random = np.random.default_rng(1)
    h, d, p = (random.integers(0, extent, 40 * count) for extent in extents)
    theta_h = ((h + 0.5) / extents[0]) ** 2 * np.pi / 2
    theta_d, phi_d = (d + 0.5) / extents[1] * np.pi / 2, (p + 0.5) / extents[2] * np.pi
    viewer, light = directions_of(theta_h, theta_d, phi_d)
    # A cell's share of all pairs.
    share = np.sqrt(theta_h) * np.sin(theta_h) * np.sin(2 * theta_d)
    keep = (np.minimum(viewer[2], light[2]) > least_cosine) & (random.random(len(h)) < share / share.max())
    keep &= np.cumsum(keep) <= count
    pick = lambda w: tuple(c[keep] for c in w)
    return pick(viewer), pick(light), table[h[keep], d[keep], p[keep]]


def compare_files(folder, scratch):
    """Compares the values of the RGL database's own files. Gonio averages both orders of light and viewer."""
    print("| file of the database | Mitsuba beside gonio, largest difference | at 99.9 % of directions |")
    print("|---|---|---|")
    for path in sorted(pathlib.Path(folder).glob("*.bsdf")):
        run(TOOL, "convert", path, scratch / "own.npy")
        viewer, light, ours = drawn_cells(np.load(scratch / "own.npy"), 20000, 0.05)
        bsdf = measured(path)
        theirs = 0.5 * (evaluate(bsdf, viewer, light) + evaluate(bsdf, light, viewer))
        off = (np.abs(theirs - ours) / (np.abs(ours) + 0.01)).max(axis=1)
        print(f"| {path.stem} | {off.max():.1e} | {np.quantile(off, 0.999):.1e} |", flush=True)
    print()


def compare_values(material):
    """Returns the mean and 99th percentile of the difference from the table, in per cent of the table's largest value
    at the same angle of incidence, and the 99.9th percentile of the relative difference from gonio's values of the
    file."""
    bsdf = measured(material["bsdf"])
    viewer, light, truth = drawn_cells(material["table"], 20000, 0.1)
    found = evaluate(bsdf, viewer, light)
    off = np.abs(found - truth).max(axis=1)
    angle = np.degrees(np.arccos(viewer[2])) // 10
    peak = np.array([truth[angle == a].max() if (angle == a).any() else 1 for a in range(9)])[angle.astype(int)]
    own = np.abs(0.5 * (found + evaluate(bsdf, light, viewer)) - drawn_cells(material["own"], 20000, 0.1)[2])
    share = own.max(axis=1) / (truth.max(axis=1) + 0.01)
    return 100 * (off / peak).mean(), 100 * np.quantile(off / peak, 0.99), np.quantile(share, 0.999)


def furnace(material, count=1 << 19):
    """Returns the largest difference of the mean weight of Mitsuba's draws from gonio's albedo, in per cent of the
    albedo: up to 60 degrees, and at 80."""
    bsdf, off, sampler = measured(material["bsdf"]), [], mi.load_dict({"type": "independent"})
    sampler.seed(7, count)
    by_angle = {round(e["theta_i"]): e["albedo"] for e in material["properties"]["energy"]["by_angle"]}
    for angle in ANGLES:
        si = dr.zeros(mi.SurfaceInteraction3f, count)
        si.wi = mi.Vector3f(one_direction(angle))
        _, weight = bsdf.sample(mi.BSDFContext(), si, sampler.next_1d(), sampler.next_2d())
        albedo = np.array(weight).mean(axis=1)
        off.append(100 * np.abs(albedo / by_angle[angle] - 1).max())
    return max(off[:-1]), off[-1]


def chi_square(material):
    """Returns how many of Mitsuba's tests at three angles pass: whether draws have the stated density."""
    passed = 0
    for angle in (5, 40, 70):
        file = f'<string name="filename" value="{material["bsdf"]}"/>'
        sample, pdf = BSDFAdapter("measured", file, wi=one_direction(angle))
        test = ChiSquareTest(domain=SphericalDomain(), sample_func=sample, pdf_func=pdf, sample_dim=3,
                             sample_count=1_000_000, res=201, ires=16)
        # A test that fails leaves a file where it runs.
        with contextlib.redirect_stdout(io.StringIO()), contextlib.chdir(material["bsdf"].parent):
            passed += bool(test.run(significance_level=0.01, test_count=3))
    return passed


def scene_of(bsdf, light, size):
    to_world = mi.ScalarTransform4f().look_at(origin=[0, 0, 5], target=[0, 0, 0], up=[0, 1, 0])
    film = {"type": "hdrfilm", "width": size, "height": size, "pixel_format": "rgba", "rfilter": {"type": "box"}}
    return mi.load_dict({
        "type": "scene", "integrator": {"type": "direct", "bsdf_samples": 16, "emitter_samples": 16,
                                        "hide_emitters": True},
        "sensor": {"type": "orthographic", "to_world": to_world, "film": film}, "light": light,
        "sphere": {"type": "sphere", "bsdf": bsdf}})


def lab(rgb):
    rgb = np.clip(rgb, 0, 1)
    xyz = rgb @ np.array([[0.4124564, 0.2126729, 0.0193339], [0.3575761, 0.7151522, 0.1191920],
                          [0.1804375, 0.0721750, 0.9503041]]) / (0.95047, 1, 1.08883)
    f = np.where(xyz > (6 / 29) ** 3, np.cbrt(xyz), xyz * (29 / 6) ** 2 / 3 + 4 / 29)
    return np.stack([116 * f[..., 1] - 16, 500 * (f[..., 0] - f[..., 1]), 200 * (f[..., 1] - f[..., 2])], -1)


def linear(codes):
    value = codes / 255
    return np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)


def sphere_difference(table, bsdf, environment, scratch, size=32, white=0.4):
    """Returns the mean CIELAB 1976 difference between gonio's sphere of a table and Mitsuba's of a BSDF."""
    run(TOOL, "render", table, "--environment", environment, "--size", size, "--quality", 2048, "--exposure", white,
        "-o", scratch / "own.png")
    border = 8
    image = np.array(mi.Bitmap(str(scratch / "own.png")))[border:-border, border:-border, :3]
    ours = linear(image.astype(float))
    # The middle of gonio's image is behind the sphere, the middle of Mitsuba's behind the camera.
    pixels = np.array(mi.Bitmap(environment).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32))
    light = {"type": "envmap", "bitmap": mi.Bitmap(np.ascontiguousarray(np.roll(pixels, pixels.shape[1] // 2, axis=1)))}
    white_image = np.array(mi.render(scene_of({"type": "diffuse", "reflectance": {"type": "rgb", "value": 1.0}}, light,
                                              size), spp=32))
    bright = (white_image[..., :3] @ (0.2126, 0.7152, 0.0722)).sum() / white_image[..., 3].sum()
    theirs = np.array(mi.render(scene_of(bsdf, light, size), spp=256))
    centre = (np.arange(size) + 0.5) / size * 2 - 1
    inside = np.hypot(*np.meshgrid(centre, centre)) < 0.97
    return np.linalg.norm(lab(theirs[..., :3] * white / bright) - lab(ours), axis=-1)[inside].mean()


def prepare(name, source, scratch):
    """Returns a material: its files, its table, the table read from its .bsdf file, and its properties."""
    material = {"name": name, "binary": scratch / f"{name}.binary", "bsdf": scratch / f"{name}.bsdf"}
    run(TOOL, *source, material["binary"])
    run(TOOL, "convert", material["binary"], material["bsdf"])
    run(TOOL, "convert", material["binary"], scratch / "table.npy")
    run(TOOL, "convert", material["bsdf"], scratch / "own.npy")
    material["table"], material["own"] = np.load(scratch / "table.npy"), np.load(scratch / "own.npy")
    material["properties"] = json.loads(run(TOOL, "properties", material["binary"], "--json"))
    return material


def compare_spectra(scratch):
    """Compares the colours of files with spectra, by Mitsuba's observer under D65, with the tables in RGB."""
    wavelengths = np.arange(360, 831, dtype=np.float32)
    observer = np.array(mi.cie1931_xyz(mi.Float(wavelengths)))
    daylight = mi.load_dict({"type": "d65"})
    si = dr.zeros(mi.SurfaceInteraction3f, len(wavelengths))
    si.wavelengths = mi.Spectrum(mi.Float(wavelengths))
    weights = observer * np.array(daylight.eval(si))[0]
    to_rgb = np.array([[3.2404542, -1.5371385, -0.4985314], [-0.9692660, 1.8760108, 0.0415560],
                       [0.0556434, -0.2040259, 1.0572252]])
    weights = to_rgb @ (weights / weights.sum(axis=1, keepdims=True) * np.array([[0.95047], [1], [1.08883]]))
    print("| material, in spectra | largest difference of a channel, % of the brightest | in the mean |")
    print("|---|---|---|")
    for name in ("red-paint", "gold-metal", "blue-rubber"):
        run(TOOL, "expand", "--formula", name, "-o", scratch / "rgb.bsdf")
        run(TOOL, "convert", "--spectra", scratch / "rgb.bsdf", scratch / "spectral.bsdf")
        run(TOOL, "convert", scratch / "rgb.bsdf", scratch / "own.npy")
        viewer, light, ours = drawn_cells(np.load(scratch / "own.npy"), 200, 0.05)
        bsdf = measured(scratch / "spectral.bsdf")
        # All wavelengths of the first pair first.
        repeated = lambda w: tuple(np.repeat(c, len(wavelengths)) for c in w)
        at = np.tile(wavelengths, len(ours))
        spectra = 0.5 * (evaluate(bsdf, repeated(viewer), repeated(light), at)
                         + evaluate(bsdf, repeated(light), repeated(viewer), at))
        found = spectra[:, 0].reshape(len(ours), -1) @ weights.T
        off = np.abs(found - ours).max(axis=1) / ours.max(axis=1)
        print(f"| {name} | {100 * off.max():.2f} | {100 * off.mean():.2f} |", flush=True)


def main():
    if "--spectra" in sys.argv:
        with tempfile.TemporaryDirectory() as name:
            print(f"Mitsuba {mi.__version__}, variant {mi.variant()}.\n")
            return compare_spectra(pathlib.Path(name))
    environment, folder, *tables = sys.argv[1:]
    sources = [(name, ("expand", "--formula", name, "-o")) for name in ("red-paint", "gold-metal", "blue-rubber")]
    sources += [(pathlib.Path(table).name.split(".")[0], ("convert", table)) for table in tables]
    with tempfile.TemporaryDirectory() as name:
        scratch = pathlib.Path(name)
        print(f"Mitsuba {mi.__version__}, variant {mi.variant()}.\n")
        compare_files(folder, scratch)
        print("| written by gonio | mean error, % of the peak | 99th percentile | the same file in gonio | "
              "furnace to 60, % | at 80, % | chi-square | sphere, Delta E |")
        print("|---|---|---|---|---|---|---|---|")
        for source in sources:
            material = prepare(*source, scratch)
            mean, high, own = compare_values(material)
            lower, grazing = furnace(material)
            passed = chi_square(material)
            sphere = sphere_difference(material["binary"], {"type": "measured", "filename": str(material["bsdf"])},
                                       environment, scratch)
            print(f"| {material['name']} | {mean:.3f} | {high:.2f} | {own:.1e} | {lower:.2f} | {grazing:.2f} | "
                  f"{passed} of 3 | {sphere:.2f} |", flush=True)


if __name__ == "__main__":
    main()
