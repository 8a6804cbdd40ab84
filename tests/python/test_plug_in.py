"""How the plug-ins for Mitsuba look values up, on numpy: Mitsuba need not be there."""

import importlib.util
import pathlib
import sys
import tempfile
import types
import unittest
from unittest import mock

import numpy as np

import gonio
from surroundings import MEASUREMENTS, SOURCE, TOOL, random_pairs, table_of_formula
from test_maps import BESIDE, write_map

STUBS = pathlib.Path(__file__).with_name("stubs")


def module_from(path, name):
    spec = importlib.util.spec_from_file_location(name, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class LookUpTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.mi = module_from(STUBS / "mitsuba.py", "mitsuba")
        stubs = {"mitsuba": cls.mi, "drjit": module_from(STUBS / "drjit.py", "drjit")}
        with mock.patch.dict(sys.modules, stubs):
            cls.plug_in = module_from(SOURCE / "examples" / "python" / "mitsuba_table.py", "mitsuba_table_on_numpy")
            with mock.patch.dict(sys.modules, {"mitsuba_table": cls.plug_in}):
                cls.of_prior = module_from(SOURCE / "examples" / "python" / "mitsuba_prior.py", "mitsuba_prior_on_numpy")
            with mock.patch.dict(sys.modules, {"mitsuba_prior": cls.of_prior}):
                cls.of_map = module_from(SOURCE / "examples" / "python" / "mitsuba_map.py", "mitsuba_map_on_numpy")

    def check_agreement(self, table):
        with tempfile.TemporaryDirectory() as folder:
            file = str(pathlib.Path(folder) / "paint.binary")
            gonio.write_merl(file, table)
            bsdf = self.plug_in.GonioTable({"filename": file})
        wi, wo = random_pairs(20000, smallest_cosine=1e-3)
        value = bsdf.reflectance(None, self.mi.Vector3f(wi.T), self.mi.Vector3f(wo.T), True).T
        np.testing.assert_allclose(value, np.maximum(table(wi, wo), 0), rtol=1e-6, atol=1e-9)

    def test_values_are_those_of_the_table(self):
        for anchor in ("centre", "lower_corner"):
            for minimum_cosine in (0, 0.02):
                with self.subTest(anchor=anchor, minimum_cosine=minimum_cosine):
                    self.check_agreement(table_of_formula("gold-metal", anchor, minimum_cosine=minimum_cosine))

    def test_weights_are_those_of_a_fit(self):
        prior = gonio.read_prior()
        fit = gonio.Decomposition(prior).fit(gonio.formula_material("red-paint").tabulate(cells=prior.cells))
        self.check_weights(self.of_prior.GonioPrior({}), fit)
        mean = gonio.Decomposition(prior, eta=1e15).fit(gonio.read_samples(MEASUREMENTS))
        self.check_weights(self.of_prior.GonioPrior({"components": 5}), mean)

    def check_weights(self, bsdf, fit):
        bsdf.weights = fit.weights[: len(bsdf.functions)].ravel()
        bsdf.parameters_changed()
        wi, wo = random_pairs(20000, smallest_cosine=1e-3)
        value = bsdf.reflectance(None, self.mi.Vector3f(wi.T), self.mi.Vector3f(wo.T), True).T
        np.testing.assert_allclose(value, fit(wi, wo), rtol=1e-5, atol=1e-7)

    @unittest.skipUnless(TOOL, "the tool is not beside the module")
    def test_texels_of_a_map(self):
        wi, wo = random_pairs(2000, smallest_cosine=1e-3)
        with tempfile.TemporaryDirectory() as folder:
            path, _ = write_map(pathlib.Path(folder))
            table, bsdf = gonio.read_map(path), self.of_map.GonioMap({"filename": str(path)})
        rows, columns = table.shape
        for row, column in ((0, 0), (0, 5), (3, 1), BESIDE):
            # Inside of the texel; the first row is at the top.
            uv = self.mi.Vector3f(np.tile([[(column + 0.9) / columns], [1 - (row + 0.1) / rows], [0]], len(wi)))
            si = types.SimpleNamespace(uv=uv)
            value = bsdf.reflectance(si, self.mi.Vector3f(wi.T), self.mi.Vector3f(wo.T), True).T
            expected = 0 * wi if (row, column) == BESIDE else table.brdf(row, column)(wi, wo)
            with self.subTest(row=row, column=column):
                np.testing.assert_allclose(value, expected, rtol=1e-5, atol=1e-7)

    def test_negative_values_are_black(self):
        table = gonio.Table(np.full((9, 9, 18, 3), -0.5))
        with tempfile.TemporaryDirectory() as folder:
            file = str(pathlib.Path(folder) / "dark.binary")
            gonio.write_merl(file, table)
            self.assertEqual(self.plug_in.GonioTable({"filename": file}).values.max(), 0)


if __name__ == "__main__":
    unittest.main()
