"""A plug-in for Mitsuba 3's vectorised RGB variants: the materials of a prior as a BSDF whose weights are parameters.

    import mitsuba as mi
    mi.set_variant("llvm_ad_rgb")
    import mitsuba_prior  # registers "gonio_prior"
    sphere = {"type": "sphere", "bsdf": {"type": "gonio_prior", "components": 20}}

`mi.traverse` finds the differentiable parameter `weights`, component by component: red, green and blue of each. Values
equal `gonio.Fit` with the same weights. `inverse_rendering.py` estimates weights from an image.
"""

import drjit as dr
import mitsuba as mi
import numpy as np

import gonio
from mitsuba_table import FIRST_VALUE, GonioTable

EPSILON = 0.001  # epsilon of the metric, Nielsen et al. 2015, Eq. 1


class GonioPrior(GonioTable):
    """`prior` is a file of `gonio learn`, by default the shipped one; `components` is the number of components to use,
    by default all; `alpha` is the GGX roughness of the sampled normals."""

    def __init__(self, props):
        mi.BSDF.__init__(self, props)
        prior = gonio.read_prior(props.get("prior", None))
        self.use(prior, prior.components[:, : int(props.get("components", len(prior)))], props)
        self.weights = dr.zeros(mi.Float, 3 * len(self.functions))
        self.parameters_changed()

    def use(self, prior, functions, props):
        """Uses functions over the prior's cells, one per column."""
        numbers = prior.cells.numbers().ravel()  # the cell that each cell of the grid reads
        self.extents, self.first_value = prior.cells.shape, FIRST_VALUE[prior.cells.anchor]
        self.functions = [mi.Float(column) for column in np.ascontiguousarray(functions[numbers].T)]
        self.mean = mi.Float(prior.mean[numbers])
        self.log_reference = mi.Float(np.log(np.maximum(prior.reference[numbers], 1e-8)))
        self.alpha = float(props.get("alpha", 0.2))
        self.m_flags = mi.BSDFFlags.GlossyReflection | mi.BSDFFlags.FrontSide
        self.m_components = [self.m_flags]

    def parameters_changed(self, keys=None):
        """Expands the weights to the mapped values of all cells, one array per channel."""
        self.mapped = []
        for channel in range(3):
            values = mi.Float(self.mean)
            for k, function in enumerate(self.functions):
                values = dr.fma(function, dr.gather(mi.Float, self.weights, 3 * k + channel), values)
            self.mapped.append(values)

    @staticmethod
    def blended(values, corners, active):
        """Interpolates values between the eight cells around a pair of directions."""
        return sum(weight * dr.gather(mi.Float, values, index, active) for weight, index in corners)

    @staticmethod
    def unmapped(mapped, log_reference, wi, wo):
        """Returns the reflectance of mapped values: Nielsen et al. 2015, Eq. 2 and 3."""
        cosines = dr.maximum(mi.Frame3f.cos_theta(wi) * mi.Frame3f.cos_theta(wo), EPSILON)
        return dr.maximum((dr.exp(mapped) * (dr.exp(log_reference) * cosines + EPSILON) - EPSILON) / cosines, 0)

    def reflectance(self, si, wi, wo, active):
        corners = list(self.corners(wi, wo))
        mapped = mi.Color3f(*(self.blended(values, corners, active) for values in self.mapped))
        return self.unmapped(mapped, self.blended(self.log_reference, corners, active), wi, wo)

    def traverse(self, callback):
        callback.put("weights", self.weights, mi.ParamFlags.Differentiable)

    def to_string(self):
        return f"GonioPrior[components = {len(self.functions)}, alpha = {self.alpha:.3f}]"


mi.register_bsdf("gonio_prior", GonioPrior)
