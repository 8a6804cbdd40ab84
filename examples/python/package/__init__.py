"""Complete BRDFs from a few reflectance measurements.

    import gonio
    prior = gonio.read_prior()
    samples = gonio.read_samples("measurements.csv")
    paint = gonio.Decomposition(prior, eta=40.0).fit(samples)
    gonio.write_merl("paint.binary", paint)

Directions are unit vectors in the local frame of the surface, normal +z; wi points to the light, wo to the viewer.
Reflectance is in sr^-1 without the cosine, colours are linear Rec. 709, angles are radians. Bad input raises
`gonio.Error`.
"""

from gonio import _gonio
from gonio._gonio import *  # noqa: F403
from gonio._gonio import __version__  # noqa: F401

__all__ = [name for name in vars(_gonio) if not name.startswith("_")]
