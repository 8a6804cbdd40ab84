"""numpy in the place of Mitsuba: what the plug-ins of examples/python need to be imported and to look values up."""

import numpy as np

is_rgb = True
Float = np.float64
Int32 = UInt32 = np.int64


def Color3f(*channels):
    return np.float64(channels[0]) if len(channels) == 1 else np.stack(channels)


class Vector3f(np.ndarray):
    """Vectors as the columns of an array of shape (3, n)."""

    def __new__(cls, rows):
        return np.asarray(rows, float).view(cls)

    x, y, z = (property(lambda self, axis=axis: np.asarray(self)[axis]) for axis in range(3))


class BSDF:
    def __init__(self, props):
        pass


class Frame3f:
    @staticmethod
    def cos_theta(vectors):
        return vectors.z


class BSDFFlags:
    GlossyReflection, FrontSide = 1, 2


def register_bsdf(name, kind):
    pass
