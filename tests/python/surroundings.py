"""Where the tests find the project's files and its tool."""

import os
import pathlib

SOURCE = pathlib.Path(__file__).resolve().parents[2]
DATA = SOURCE / "examples" / "data"
MEASUREMENTS = DATA / "measurements.csv"
PRIOR = DATA / "materials.prior"

# The tool that was built beside the module; there is none beside a wheel.
TOOL = os.environ.get("GONIO_TOOL")


def unit(theta, phi):
    """A unit vector at a polar angle and an azimuth in radians."""
    import numpy as np

    return np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)


def random_pairs(count, smallest_cosine):
    """Light and viewer of pairs above the horizon, uniform in the cosine: two arrays of shape (count, 3)."""
    import numpy as np

    generator = np.random.default_rng(1)
    return tuple(
        unit(np.arccos(generator.uniform(smallest_cosine, 1, count)), generator.uniform(0, 2 * np.pi, count))
        for _ in range(2)
    )


def table_of_formula(name, anchor, shape=(45, 30, 60), minimum_cosine=0.0):
    """A formula material at the nodes of a grid."""
    import numpy as np

    import gonio

    table = gonio.Table(np.zeros(shape + (3,)), anchor=anchor, minimum_cosine=minimum_cosine)
    directions = table.directions()
    table.values[:] = gonio.formula_material(name)(directions[:, :3], directions[:, 3:])
    return table
