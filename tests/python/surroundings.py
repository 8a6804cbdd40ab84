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
