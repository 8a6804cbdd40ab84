"""A plug-in for Mitsuba 3's vectorised RGB variants: a table of gonio as a BSDF, with importance sampling.

    import mitsuba as mi
    mi.set_variant("llvm_ad_rgb")
    import mitsuba_table  # registers "gonio_table"
    sphere = {"type": "sphere", "bsdf": {"type": "gonio_table", "filename": "paint.binary"}}

Values are interpolated as in `gonio.Table`. Half of the directions are sampled from visible normals of a GGX
distribution as wide as the table's highlight, the other half by the cosine.
"""

import drjit as dr
import mitsuba as mi
import numpy as np

import gonio

SPECULAR_SHARE = 0.5


# Distance from the beginning of an axis to its first value, in cells.
FIRST_VALUE = {"centre": 0.5, "lower_corner": 0.0}


def highlight_roughness(table):
    """Returns GGX's alpha, from the theta_h at which the highlight of light at 20 degrees has half its height."""
    theta_h = np.radians(np.linspace(0, 60, 241))
    angles = np.stack([theta_h, np.full_like(theta_h, np.radians(20)), np.full_like(theta_h, np.pi / 2)], axis=1)
    pairs = gonio.Samples(angles, np.ones(len(angles))).directions
    brightness = table(pairs[:, :3], pairs[:, 3:]).sum(axis=1)
    excess = brightness - brightness[-1]
    half = theta_h[np.argmax(excess <= excess[0] / 2)] if excess[0] > 0 else np.pi / 4
    return float(np.clip(np.tan(half) / np.sqrt(np.sqrt(2) - 1), 0.02, 1))


class GonioTable(mi.BSDF):
    """`filename` is a MERL file."""

    def __init__(self, props):
        mi.BSDF.__init__(self, props)
        if not mi.is_rgb:
            raise gonio.Error("gonio_table needs an RGB variant of Mitsuba, not " + mi.variant())
        table = gonio.read_merl(props["filename"])
        self.extents, self.first_value = table.shape, FIRST_VALUE[table.anchor]
        self.values = mi.Float(np.maximum(table.dense(fill=True), 0).ravel())  # uploaded once
        self.alpha = highlight_roughness(table)
        self.m_flags = mi.BSDFFlags.GlossyReflection | mi.BSDFFlags.FrontSide
        self.m_components = [self.m_flags]

    # ---- the table --------------------------------------------------------------------------------------------------

    def coordinates(self, wi, wo):
        """Returns a pair's grid coordinates along theta_h, theta_d and phi_d, in cells from the first value."""
        along_half, difference = wi + wo, wi - wo
        length = dr.norm(along_half)
        half = along_half * dr.rcp(dr.maximum(length, 1e-20))
        sine = dr.hypot(half.x, half.y)
        cos_phi = dr.select(sine > 0, half.x / sine, 1)
        sin_phi = dr.select(sine > 0, half.y / sine, 0)
        along = cos_phi * difference.x + sin_phi * difference.y
        x = half.z * along - sine * difference.z
        y = cos_phi * difference.y - sin_phi * difference.x
        theta_h, theta_d = dr.atan2(sine, half.z), dr.atan2(dr.norm(difference), length)
        phi_d = dr.atan2(y, x) / dr.pi
        phi_d -= dr.floor(phi_d)
        shares = dr.sqrt(theta_h * (2 / dr.pi)), theta_d * (2 / dr.pi), phi_d
        return tuple(share * extent - self.first_value for share, extent in zip(shares, self.extents))

    def corners(self, wi, wo):
        """Yields weights and indices of the eight nearest values; clamps theta_h and theta_d, wraps phi_d around."""
        h, d, p = self.coordinates(wi, wo)
        heights, rows, columns = self.extents
        h, d = dr.clip(h, 0, heights - 1), dr.clip(d, 0, rows - 1)
        low = [mi.Int32(dr.floor(c)) for c in (h, d, p)]
        share = [c - dr.floor(c) for c in (h, d, p)]
        for corner in range(8):
            up = [corner >> axis & 1 for axis in range(3)]
            weight = mi.Float(1)
            for axis in range(3):
                weight *= share[axis] if up[axis] else 1 - share[axis]
            theta_h = dr.minimum(low[0] + up[0], heights - 1)
            theta_d = dr.minimum(low[1] + up[1], rows - 1)
            phi_d = low[2] + up[2]
            phi_d = dr.select(phi_d < 0, phi_d + columns, dr.select(phi_d >= columns, phi_d - columns, phi_d))
            yield weight, mi.UInt32((theta_h * rows + theta_d) * columns + phi_d)

    def reflectance(self, si, wi, wo, active):
        total = mi.Color3f(0)
        for weight, index in self.corners(wi, wo):
            total += weight * dr.gather(mi.Color3f, self.values, index, active)
        return total

    # ---- Mitsuba's interface -----------------------------------------------------------------------------------------

    def normals(self):
        return mi.MicrofacetDistribution(mi.MicrofacetType.GGX, self.alpha, True)

    def lit(self, ctx, si, wo, active):
        enabled = ctx.is_enabled(mi.BSDFFlags.GlossyReflection)
        return active & enabled & (mi.Frame3f.cos_theta(si.wi) > 0) & (mi.Frame3f.cos_theta(wo) > 0)

    def eval(self, ctx, si, wo, active=True):
        active = self.lit(ctx, si, wo, mi.Bool(active))
        return dr.select(active, self.reflectance(si, si.wi, wo, active) * mi.Frame3f.cos_theta(wo), 0)

    def pdf(self, ctx, si, wo, active=True):
        active = self.lit(ctx, si, wo, mi.Bool(active))
        half = dr.normalize(si.wi + wo)
        specular = self.normals().pdf(si.wi, half) / (4 * dr.maximum(dr.dot(wo, half), 1e-20))
        cosine = mi.warp.square_to_cosine_hemisphere_pdf(wo)
        return dr.select(active, dr.lerp(cosine, specular, SPECULAR_SHARE), 0)

    def eval_pdf(self, ctx, si, wo, active=True):
        return self.eval(ctx, si, wo, active), self.pdf(ctx, si, wo, active)

    def sample(self, ctx, si, sample1, sample2, active=True):
        half, _ = self.normals().sample(si.wi, sample2)
        wo = dr.select(sample1 < SPECULAR_SHARE, mi.reflect(si.wi, half), mi.warp.square_to_cosine_hemisphere(sample2))
        value, density = self.eval_pdf(ctx, si, wo, active)
        drawn = dr.zeros(mi.BSDFSample3f)
        drawn.wo = wo
        drawn.pdf = density
        drawn.eta = 1
        drawn.sampled_type = mi.UInt32(+mi.BSDFFlags.GlossyReflection)
        drawn.sampled_component = 0
        return drawn, dr.select(density > 0, value / density, 0)

    def traverse(self, callback):
        callback.put("values", self.values, mi.ParamFlags.Differentiable)

    def to_string(self):
        return f"GonioTable[extents = {self.extents}, alpha = {self.alpha:.3f}]"


mi.register_bsdf("gonio_table", GonioTable)
