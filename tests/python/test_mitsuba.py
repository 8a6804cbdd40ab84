"""The plug-in for Mitsuba 3, where Mitsuba is installed and finds LLVM."""

import contextlib
import io
import pathlib
import sys
import tempfile
import unittest

import numpy as np

import gonio
from surroundings import MEASUREMENTS, SOURCE, TOOL, random_pairs, table_of_formula, unit
from test_maps import BESIDE, write_map

try:
    import drjit as dr
    import mitsuba as mi

    mi.set_variant("llvm_ad_rgb")
    dr.eval(mi.Float(1) + 1)  # fails without LLVM
    sys.path.insert(0, str(SOURCE / "examples" / "python"))
    import mitsuba_map  # noqa: F401
    import mitsuba_prior  # noqa: F401
    import mitsuba_table  # noqa: F401
    from mitsuba.chi2 import BSDFAdapter, ChiSquareTest, SphericalDomain
except (ImportError, RuntimeError) as unavailable:
    raise unittest.SkipTest(f"Mitsuba's variant llvm_ad_rgb is not there: {unavailable}")


class PlugInTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.file = str(pathlib.Path(cls.folder.name) / "paint.binary")
        cls.table = gonio.formula_material("red-paint").tabulate()
        gonio.write_merl(cls.file, cls.table)

    def surface(self, wi):
        si = dr.zeros(mi.SurfaceInteraction3f, len(wi))
        si.wi = mi.Vector3f(np.ascontiguousarray(wi.T, dtype=np.float32))
        return si

    def test_values_are_those_of_the_table(self):
        # The last half a degree above the horizon is left out: there single precision decides what is above it.
        wi, wo = random_pairs(20000, smallest_cosine=0.01)
        for anchor in ("centre", "lower_corner"):
            table = table_of_formula("red-paint", anchor, shape=(90, 90, 180))
            gonio.write_merl(self.file + anchor, table)
            bsdf = mi.load_dict({"type": "gonio_table", "filename": self.file + anchor})
            value = bsdf.eval(mi.BSDFContext(), self.surface(wi), mi.Vector3f(np.ascontiguousarray(wo.T, np.float32)))
            expected = np.maximum(table(wi, wo), 0) * wo[:, 2:]
            with self.subTest(anchor=anchor):
                np.testing.assert_allclose(np.array(value).T, expected, rtol=3e-4, atol=1e-9)

    def test_black_below_the_horizon(self):
        bsdf = mi.load_dict({"type": "gonio_table", "filename": self.file})
        up, down = np.array([[0, 0, 1.0]]), np.array([[0, 0, -1.0]])
        for wi, wo in ((up, down), (down, up)):
            value, density = bsdf.eval_pdf(mi.BSDFContext(), self.surface(wi), mi.Vector3f(wo[0].tolist()))
            self.assertEqual((np.abs(np.array(value)).max(), np.array(density).max()), (0, 0))

    def test_samples_follow_the_density(self):
        for degrees in (0.0, 40.0, 75.0):
            wi = unit(np.radians(degrees), 0.3).tolist()
            sample, density = BSDFAdapter("gonio_table", f'<string name="filename" value="{self.file}"/>', wi=wi)
            test = ChiSquareTest(domain=SphericalDomain(), sample_func=sample, pdf_func=density, sample_dim=3,
                                 sample_count=200000, res=51, ires=8)
            with contextlib.redirect_stdout(io.StringIO()):
                accepted = test.run()
            self.assertTrue(accepted, f"{degrees} degrees: p is {test.p_value}")

    def test_white_reflects_all_light(self):
        gonio.write_merl(self.file + "-white", gonio.Table(np.full((90, 90, 180, 3), 1 / np.pi)))
        bsdf = mi.load_dict({"type": "gonio_table", "filename": self.file + "-white"})
        count = 100000
        sampler = mi.load_dict({"type": "independent"})
        sampler.seed(1, count)
        si = self.surface(np.repeat([unit(np.radians(30.0), 0.0)], count, axis=0))
        _, weight = bsdf.sample(mi.BSDFContext(), si, sampler.next_1d(), sampler.next_2d())
        np.testing.assert_allclose(np.array(weight).mean(axis=1), 1, atol=0.02)


class PriorTest(unittest.TestCase):
    def test_derivatives_by_weights_are_those_of_a_fit(self):
        fit = gonio.Decomposition(gonio.read_prior()).fit(gonio.read_samples(MEASUREMENTS))
        bsdf = mi.load_dict({"type": "gonio_prior", "components": len(fit.weights)})
        parameters = mi.traverse(bsdf)
        weights = mi.Float(fit.weights.astype(np.float32).ravel())
        dr.enable_grad(weights)
        parameters["weights"] = weights
        parameters.update()
        wi, wo = random_pairs(50, smallest_cosine=0.1)
        si = dr.zeros(mi.SurfaceInteraction3f, len(wi))
        si.wi = mi.Vector3f(np.ascontiguousarray(wi.T, dtype=np.float32))
        value = bsdf.eval(mi.BSDFContext(), si, mi.Vector3f(np.ascontiguousarray(wo.T, np.float32)))
        np.testing.assert_allclose(np.array(value).T, fit(wi, wo) * wo[:, 2:], rtol=1e-3, atol=1e-6)
        dr.backward(dr.sum(value.x) + 2 * dr.sum(value.z))
        expected = np.einsum("nck,n,c->kc", fit.gradient(wi, wo), wo[:, 2], [1, 0, 2])
        scale = np.abs(expected).max()
        np.testing.assert_allclose(np.array(dr.grad(weights)).reshape(-1, 3), expected, atol=1e-3 * scale)


@unittest.skipUnless(TOOL, "the tool is not beside the module")
class MapTest(unittest.TestCase):
    def test_a_rectangle_has_the_colours_of_its_texels(self):
        with tempfile.TemporaryDirectory() as folder:
            path, _ = write_map(pathlib.Path(folder))
            table = gonio.read_map(path)
            rows, columns = table.shape
            look = mi.ScalarTransform4f().look_at(origin=[0, 0, 4], target=[0, 0, 0], up=[0, 1, 0])
            scene = mi.load_dict({
                "type": "scene",
                "integrator": {"type": "direct"},
                "light": {"type": "directional", "direction": [-0.6, 0, -0.8], "irradiance": 1.0},
                "sample": {"type": "rectangle", "to_world": mi.ScalarTransform4f().scale([1, rows / columns, 1]),
                           "bsdf": {"type": "gonio_map", "filename": str(path)}},
                "sensor": {"type": "orthographic", "to_world": look,
                           "film": {"type": "hdrfilm", "width": columns, "height": rows, "rfilter": {"type": "box"}}},
            })
            image = np.array(mi.render(scene, spp=16))
        for row in range(rows):
            for column in range(columns):
                inside = (row, column) != BESIDE
                expected = 0.8 * table.brdf(row, column)([0.6, 0, 0.8], [0, 0, 1]) if inside else np.zeros(3)
                np.testing.assert_allclose(image[row, column], expected, rtol=1e-3, atol=1e-6)


if __name__ == "__main__":
    unittest.main()
