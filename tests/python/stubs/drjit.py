"""numpy in the place of Dr.Jit: what the plug-ins of examples/python call to look values up."""

import numpy as np
from numpy import arctan2 as atan2  # noqa: F401
from numpy import clip, exp, floor, hypot, maximum, minimum, pi, sqrt  # noqa: F401
from numpy import where as select  # noqa: F401


def norm(vectors):
    return np.linalg.norm(np.asarray(vectors), axis=0)


def rcp(numbers):
    return 1 / numbers


def fma(a, b, c):
    return a * b + c


def zeros(kind, count):
    return np.zeros(count)


def gather(kind, source, index, active=True):
    return source.reshape(-1, 3)[index].T if kind.__name__ == "Color3f" else source[index]
