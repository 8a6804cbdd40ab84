"""numpy in the place of Dr.Jit: what examples/python/mitsuba_table.py calls to look a table up."""

import numpy as np
from numpy import arctan2 as atan2  # noqa: F401
from numpy import clip, floor, hypot, maximum, minimum, pi, sqrt  # noqa: F401
from numpy import where as select  # noqa: F401


def norm(vectors):
    return np.linalg.norm(np.asarray(vectors), axis=0)


def rcp(numbers):
    return 1 / numbers


def gather(kind, source, index, active):
    return source.reshape(-1, 3)[index].T
