"""Shared parts of the scripts that compare renderers' spheres with gonio's: size, lights and colour differences."""

import numpy as np

import gonio

SIZE, FINER = 128, 4
LIGHTS = [(-1.0, -1.0, -1.0), (1.0, 1.0, 3.0)]  # directions in which gonio's two lights shine
WHITE = 0.4  # the mean luminance of a white matt sphere


def disc():
    y, x = np.mgrid[:SIZE, :SIZE] - (SIZE - 1) / 2
    return np.hypot(x, y) < 0.98 * SIZE / 2


def lab(image):
    """Returns CIELAB (D65) of linear Rec. 709, clipped as by a display."""
    rgb = np.clip(image[disc()], 0, 1)
    xyz = rgb @ np.array([[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750],
                          [0.0193339, 0.1191920, 0.9503041]]).T / [0.95047, 1, 1.08883]
    f = np.where(xyz > (6 / 29) ** 3, np.cbrt(xyz), xyz / 3 * (29 / 6) ** 2 + 4 / 29)
    return np.stack([116 * f[:, 1] - 16, 500 * (f[:, 0] - f[:, 1]), 200 * (f[:, 1] - f[:, 2])], axis=1)


def delta_e(a, b):
    return np.linalg.norm(lab(a) - lab(b), axis=1)


def coarser(image):
    return image.reshape(SIZE, FINER, SIZE, FINER, 3).mean(axis=(1, 3))


def luminance(image):
    return (image[disc()] @ [0.2126729, 0.7151522, 0.0721750]).mean()


class GonioSphere:
    """Gonio's rendering of a sphere, averaged from several times the size, and exposed."""

    def __init__(self, render):
        self.render, self.exposure = render, 1.0
        self.exposure = WHITE / luminance(self(gonio.Table(np.full((9, 9, 18, 3), 1 / np.pi))))

    def __call__(self, brdf):
        return self.exposure * coarser(self.render(brdf, size=FINER * SIZE))
