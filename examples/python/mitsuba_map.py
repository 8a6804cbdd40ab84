"""A plug-in for Mitsuba 3's vectorised RGB variants: a map of `gonio svbrdf` as a spatially varying BSDF.

    import mitsuba as mi
    mi.set_variant("llvm_ad_rgb")
    import mitsuba_map  # registers "gonio_map"
    sample = {"type": "rectangle", "bsdf": {"type": "gonio_map", "filename": "leaf.gsv"}}

The first row of texels is at the top, v = 1. Each point has the BRDF of its texel; texels outside the sample are black.
Values equal `gonio.Map.brdf`.
"""

import drjit as dr
import mitsuba as mi
import numpy as np

import gonio
from mitsuba_prior import GonioPrior


class GonioMap(GonioPrior):
    """`filename` is a map, `prior` the file of the prior that it was made with, by default the shipped one; `alpha` is
    the GGX roughness of the sampled normals."""

    def __init__(self, props):
        mi.BSDF.__init__(self, props)
        prior = gonio.read_prior(props.get("prior", None))
        table = gonio.read_map(props["filename"], prior)
        self.use(prior, prior.components @ table.functions, props)
        self.rows, self.columns = table.shape
        self.is_sample = mi.Float((np.asarray(table.uncertainty) > 0).astype(np.float32).ravel())
        weights = table.weights.astype(np.float32).reshape(-1, 3, len(self.functions))
        # For each function: red, green and blue of all texels.
        self.weights = [mi.Float(np.ascontiguousarray(weights[:, :, k]).ravel()) for k in range(len(self.functions))]

    def texel(self, uv):
        row = dr.clip(mi.Int32(dr.floor((1 - uv.y) * self.rows)), 0, self.rows - 1)
        column = dr.clip(mi.Int32(dr.floor(uv.x * self.columns)), 0, self.columns - 1)
        return mi.UInt32(row * self.columns + column)

    def reflectance(self, si, wi, wo, active):
        texel = self.texel(si.uv)
        corners = list(self.corners(wi, wo))
        mapped = mi.Color3f(self.blended(self.mean, corners, active))
        for function, weights in zip(self.functions, self.weights):
            mapped = mapped + self.blended(function, corners, active) * dr.gather(mi.Color3f, weights, texel, active)
        value = self.unmapped(mapped, self.blended(self.log_reference, corners, active), wi, wo)
        return value * dr.gather(mi.Float, self.is_sample, texel, active)

    def traverse(self, callback):
        pass

    def to_string(self):
        return f"GonioMap[{self.rows} x {self.columns} texels, {len(self.functions)} functions]"


mi.register_bsdf("gonio_map", GonioMap)
