import unittest

import numpy as np

import gonio
from surroundings import unit


class FitTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        generator = np.random.default_rng(1)
        wi, wo = (unit(generator.uniform(0, 1.3, 400), generator.uniform(0, 6, 400)) for _ in range(2))
        cls.paint = gonio.formula_material("red-paint")
        cls.samples = gonio.Samples(np.hstack([wi, wo]), cls.paint(wi, wo))

    def test_of_samples(self):
        fit = gonio.fit_model(self.samples)
        self.assertTrue(fit.converged)
        self.assertEqual([lobe["lobe"] for lobe in fit.model.lobes], ["lambert", "ggx"])
        values, directions = self.samples.values, self.samples.directions
        error = np.median(np.abs(fit.model(directions[:, :3], directions[:, 3:]) - values) / values)
        self.assertLess(error, 0.2)

    def test_named_lobes(self):
        fit = gonio.fit_model(self.samples, "sum:ward", loss="l1", metric="cubic")
        self.assertEqual([lobe["lobe"] for lobe in fit.model.lobes], ["ward"])

    def test_no_fit_reflects_more_than_falls_in(self):
        bright = gonio.Samples(self.samples.directions, 4 * self.samples.values)
        bounded, free = gonio.fit_model(bright), gonio.fit_model(bright, largest_albedo=np.inf)
        self.assertGreater(bounded.loss, free.loss)
        self.assertLess(bounded.model.lobes[1]["colour"][0], free.model.lobes[1]["colour"][0])

    def test_of_a_table(self):
        grey = gonio.Table(np.full((12, 12, 24, 3), 0.1))
        colour = gonio.fit_model(grey, "lambert", loss="l2", metric="lin", cell_weights="cosine").model.lobes[0]["colour"]
        np.testing.assert_allclose(colour, [0.1 * np.pi] * 3, rtol=1e-3)

    def test_materials_of_renderers(self):
        model = gonio.fit_model(self.samples).model
        self.assertIn("<bsdf", model.mitsuba())
        self.assertIn("Material", model.pbrt())

    def test_refusals(self):
        with self.assertRaisesRegex(gonio.Error, "largest albedo must be positive"):
            gonio.fit_model(self.samples, largest_albedo=0.0)
        for arguments, sentence in [
            (("phing",), "phing"),
            (("sum:ggx+",), ""),
        ]:
            with self.subTest(arguments=arguments), self.assertRaisesRegex(gonio.Error, sentence):
                gonio.fit_model(self.samples, *arguments)
        with self.assertRaisesRegex(gonio.Error, "metric is 'inch': expected one of cubic, lin, log"):
            gonio.fit_model(self.samples, metric="inch")
        with self.assertRaisesRegex(gonio.Error, "starts is -1"):
            gonio.fit_model(self.samples, starts=-1)
        with self.assertRaises(gonio.Error):
            gonio.formula_material("cheese")


if __name__ == "__main__":
    unittest.main()
