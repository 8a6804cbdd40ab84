"""A BRDF of any kind is taken wherever a table is, written to files, and shown in notebooks."""

import base64
import html
import pathlib
import pickle
import tempfile
import unittest

import numpy as np

import gonio
from surroundings import MEASUREMENTS, random_pairs, table_of_formula


class AnyBrdfTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        samples, prior = gonio.read_samples(MEASUREMENTS), gonio.read_prior()
        cls.all = [
            gonio.formula_material("gold-metal"),
            gonio.fit_model(samples, "ggx").model,
            gonio.Decomposition(prior).fit(samples),
            gonio.Estimator(prior).fit(samples),
        ]
        cls.truth = table_of_formula("red-paint", "lower_corner", shape=(30, 30, 60))

    def each(self):
        for brdf in self.all:
            with self.subTest(type=type(brdf).__name__):
                yield brdf

    def test_as_a_table(self):
        for brdf in self.each():
            np.testing.assert_array_equal(gonio.Table(brdf).values, brdf.tabulate().values)

    def test_over_the_cells_of_another_table(self):
        wi, wo = np.split(self.truth.directions(), 2, axis=1)
        for brdf in self.each():
            table = brdf.tabulate(cells=self.truth.cells)
            self.assertTrue(table.cells == self.truth.cells)
            difference = np.abs(table.values - brdf(wi, wo)) / (brdf(wi, wo) + 1e-3)
            self.assertLess(np.median(difference), 1e-3)

    def test_spheres(self):
        light = np.ones((8, 16, 3))
        for brdf in self.each():
            table = brdf.tabulate()
            np.testing.assert_array_equal(gonio.render_sphere(brdf, size=16), gonio.render_sphere(table, size=16))
            np.testing.assert_array_equal(gonio.render_sphere_in(brdf, light, size=16, quality=4),
                                          gonio.render_sphere_in(table, light, size=16, quality=4))

    def test_comparisons_are_over_the_cells_of_the_table(self):
        first, _, fit, _ = self.all
        for brdf in (first, fit):
            here = brdf.tabulate(cells=self.truth.cells)
            self.assertEqual(gonio.compare(brdf, self.truth), gonio.compare(here, self.truth))
            self.assertEqual(gonio.compare(self.truth, brdf), gonio.compare(self.truth, here))
        self.assertEqual(gonio.compare(first, fit), gonio.compare(first.tabulate(), fit.tabulate()))
        for estimate, truth, name in ((3, self.truth, "estimate"), (self.truth, "paint", "truth")):
            with self.assertRaisesRegex(gonio.Error, f"^{name} is .*: expected a BRDF of gonio, such as a Table$"):
                gonio.compare(estimate, truth)

    def test_fits(self):
        gold, prior = self.all[0], gonio.read_prior()
        one, other = (gonio.fit_model(f, "lambert", metric="lin", loss="l2") for f in (gold, gold.tabulate()))
        self.assertEqual(one.model.lobes, other.model.lobes)
        estimator = gonio.Decomposition(prior)
        np.testing.assert_array_equal(estimator.fit(gold).weights, estimator.fit(gold.tabulate()).weights)

    def test_a_table_is_copied_as_it_is(self):
        again = gonio.Table(self.truth)
        self.assertEqual((again.anchor, again.shape), (self.truth.anchor, self.truth.shape))
        again.values[:] = 777
        self.assertLess(self.truth.values.max(), 777)

    def test_zeros_over_cells(self):
        table = gonio.Table(self.truth.cells)
        self.assertTrue(table.cells == self.truth.cells)
        self.assertEqual(table.values.max(), 0)


class FileTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name) / "gold.bsdf"

    def test_rgl(self):
        gold = gonio.formula_material("gold-metal")
        wi, wo = random_pairs(2000, smallest_cosine=0.1)
        gonio.write_rgl(self.path, gold)
        stored = gonio.read_rgl(self.path)
        self.assertLess(np.median(np.abs(stored(wi, wo) / gold(wi, wo) - 1)), 0.01)
        before = self.path.read_bytes()
        gonio.write_rgl(self.path, stored)
        np.testing.assert_array_equal(gonio.read_rgl(self.path)(wi, wo), stored(wi, wo))
        self.assertEqual(len(self.path.read_bytes()), len(before))
        again = pickle.loads(pickle.dumps(stored))
        np.testing.assert_array_equal(again(wi, wo), stored(wi, wo))
        self.assertEqual(repr(again), "<gonio.AdaptiveBrdf>")

    def test_rgl_has_no_negative_values(self):
        silk = gonio.Table(np.full((12, 12, 24, 3), [-0.1, 0.1, 0.2]))
        gonio.write_rgl(self.path, silk)
        wi, wo = random_pairs(200, smallest_cosine=0.2)
        values = gonio.read_rgl(self.path)(wi, wo)
        self.assertGreaterEqual(values.min(), 0.0)
        np.testing.assert_allclose(values[:, 1], 0.1, rtol=0.06)

    def test_rgl_that_cannot_be_written(self):
        with self.assertRaisesRegex(gonio.Error, "nowhere"):
            gonio.write_rgl("/nowhere/gold.bsdf", gonio.formula_material("gold-metal"))

    def test_documents_of_renderers(self):
        model = gonio.fit_model(gonio.read_samples(MEASUREMENTS), "ggx").model
        self.assertIn("<open_pbr_surface", model.materialx("gold"))
        self.assertIn('"gold"', model.materialx("gold"))
        self.assertIn('"materials"', model.gltf())


class NotebookTest(unittest.TestCase):
    def check(self, thing):
        shown = thing._repr_html_()
        image, sentence = shown.split("<br>")
        png = base64.b64decode(image.split("base64,")[1].split('"')[0])
        self.assertEqual(png[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(int.from_bytes(png[16:20], "big"), 96)
        self.assertEqual(html.unescape(sentence), f"<code>{thing!r}</code>")
        self.assertNotIn("<gonio", shown)

    def test_what_notebooks_show(self):
        self.check(gonio.formula_material("gold-metal"))
        self.check(table_of_formula("gold-metal", "lower_corner"))
        with self.assertWarns(UserWarning):
            self.check(gonio.reconstruct(gonio.read_samples(MEASUREMENTS), "pull-push"))


if __name__ == "__main__":
    unittest.main()
