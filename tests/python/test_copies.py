"""Objects are handed on: copied, pickled, printed, and taken by numpy."""

import copy
import pickle
import unittest

import numpy as np

import gonio
from surroundings import MEASUREMENTS, random_pairs, table_of_formula


def pickled(thing):
    return pickle.loads(pickle.dumps(thing, protocol=5))


WAYS = (copy.copy, copy.deepcopy, pickled)


class CopyTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.prior = gonio.read_prior()
        cls.samples = gonio.read_samples(MEASUREMENTS)
        cls.wi, cls.wo = random_pairs(500, smallest_cosine=0.05)

    def check_brdf(self, brdf):
        for way in WAYS:
            with self.subTest(type=type(brdf).__name__, way=way.__name__):
                again = way(brdf)
                self.assertIs(type(again), type(brdf))
                np.testing.assert_array_equal(again(self.wi, self.wo), brdf(self.wi, self.wo))
                self.assertEqual(repr(again), repr(brdf))

    def test_tables(self):
        for anchor in ("centre", "lower_corner"):
            table = table_of_formula("gold-metal", anchor, shape=(9, 9, 18), minimum_cosine=0.1)
            table.values[3] = -1.5
            self.check_brdf(table)
            for way in WAYS:
                again = way(table)
                np.testing.assert_array_equal(again.values, table.values)
                self.assertTrue(again.cells == table.cells)
                again.values[:] = 777
                self.assertLess(table.values.max(), 777)

    def test_samples_to_the_last_bit(self):
        by_angles = gonio.Samples(self.samples.angles, self.samples.values, np.arange(20) / 7)
        for samples in (self.samples, by_angles):
            for way in WAYS:
                again = way(samples)
                for column in ("directions", "angles", "values", "weights"):
                    np.testing.assert_array_equal(getattr(again, column), getattr(samples, column))
                again.values[:] = 777
                self.assertLess(samples.values.max(), 777)

    def test_a_prior(self):
        for way in WAYS:
            again = way(self.prior)
            for name in ("components", "mean", "reference", "cosine_weight", "singular_values", "wavelengths"):
                np.testing.assert_array_equal(getattr(again, name), getattr(self.prior, name))
            self.assertEqual((again.names, again.source, again.explained_variance),
                             (self.prior.names, self.prior.source, self.prior.explained_variance))
            np.testing.assert_array_equal(again.weights_of(again.names[5]), self.prior.weights_of(self.prior.names[5]))
            self.assertEqual(repr(again), repr(self.prior))

    def test_fits(self):
        fit = gonio.Decomposition(self.prior, eta=3.0).fit(self.samples)
        self.check_brdf(fit)
        self.assertEqual(pickled(fit).report, fit.report)
        again = pickled(gonio.Decomposition(self.prior, eta=3.0))
        np.testing.assert_array_equal(again.fit(self.samples).weights, fit.weights)

    def test_reconstructed(self):
        wrong = self.samples[:]
        wrong.values[5] *= 20
        for reject in (True, False):
            estimator = gonio.Estimator(self.prior, variance=0.03, noise=0.02, reject=reject)
            fit = estimator.fit(wrong)
            self.check_brdf(fit)
            self.assertEqual(pickled(fit).rejected, fit.rejected)
            np.testing.assert_array_equal(pickled(fit).known_to(self.wi, self.wo), fit.known_to(self.wi, self.wo))
            np.testing.assert_array_equal(pickled(estimator).fit(wrong)(self.wi, self.wo), fit(self.wi, self.wo))

    def test_reconstruction(self):
        with self.assertWarns(UserWarning):
            found = gonio.reconstruct(self.samples, "pull-push")
        for way in WAYS:
            again = way(found)
            np.testing.assert_array_equal(again.table.values, found.table.values)
            self.assertEqual((again.sentence, again.details, again.warnings, again.uncertainty),
                             (found.sentence, found.details, found.warnings, None))

    def test_models(self):
        fit = gonio.fit_model(self.samples, "ggx")
        self.check_brdf(gonio.formula_material("gold-metal"))
        self.check_brdf(fit.model)
        self.assertEqual(pickled(fit).model.lobes, fit.model.lobes)
        for way in WAYS:
            again = way(fit)
            self.assertEqual((again.loss, again.evaluations, again.converged, again.promised_gain),
                             (fit.loss, fit.evaluations, fit.converged, fit.promised_gain))

    def test_a_design(self):
        design = gonio.expected_error(self.prior, gonio.published_directions(5))
        for way in WAYS:
            again = way(design)
            np.testing.assert_array_equal(again.directions, design.directions)
            self.assertEqual((again.value, again.expected_error, again.unknown_share),
                             (design.value, design.expected_error, design.unknown_share))

    def test_pickles_of_others_are_refused(self):
        _, arguments, state = gonio.Table(np.zeros((9, 9, 18, 3))).__reduce_ex__(2)[:3]
        table = gonio.Table.__new__(*arguments)
        with self.assertRaisesRegex(gonio.Error, "a pickle of another version of gonio has 1 parts: expected 2"):
            table.__setstate__(state[:1])
        with self.assertRaisesRegex(gonio.Error, "a pickle holds 5 numbers: expected"):
            gonio.Table.__new__(*arguments).__setstate__((state[0], np.zeros(5, np.float32)))


class PrintedTest(unittest.TestCase):
    def test_repr(self):
        prior, samples = gonio.read_prior(), gonio.read_samples(MEASUREMENTS)
        for thing, text in [
            (gonio.Table(), "<gonio.Table: 90 x 90 x 180 cells, values at their centre>"),
            (table_of_formula("gold-metal", "lower_corner", shape=(9, 8, 18)),
             "<gonio.Table: 9 x 8 x 18 cells, values at their lower corner>"),
            (samples, "<gonio.Samples: 20, from 0.008 to 25.6 sr^-1>"),
            (prior, "<gonio.Prior: 100 components of 137 materials, 90 x 30 x 36 cells, values at their centre>"),
            (gonio.Decomposition(prior), "<gonio.Decomposition: eta 40.0>"),
            (gonio.Decomposition(prior).fit(samples), "<gonio.Fit: 100 components>"),
            (gonio.Estimator(prior, noise=0.02), "<gonio.Estimator: noise 0.02>"),
            (gonio.Estimator(prior).fit(samples), "<gonio.ReconstructedBrdf: of 20 samples, 0 rejected>"),
            (gonio.formula_material("gold-metal"), "<gonio.FormulaBrdf: gold-metal>"),
            (gonio.fit_model(samples, "ggx").model, "<gonio.AnalyticBrdf: lambert + ggx>"),
        ]:
            with self.subTest(type=type(thing).__name__):
                self.assertEqual(repr(thing), text)


class ArrayTest(unittest.TestCase):
    def setUp(self):
        self.table = table_of_formula("gold-metal", "lower_corner", shape=(9, 8, 18))

    def test_a_table_is_an_array(self):
        dense = self.table.dense()
        np.testing.assert_array_equal(np.asarray(self.table), dense)
        np.testing.assert_array_equal(np.array(self.table, dtype=np.float64), dense.astype(np.float64))
        self.assertEqual(np.array(self.table, dtype=np.float64).dtype, np.float64)
        self.assertAlmostEqual(float(np.nanmax(self.table)), float(np.nanmax(dense)))

    def test_no_array_without_a_copy(self):
        with self.assertRaisesRegex(ValueError, "copy=False"):
            self.table.__array__(copy=False)

    def test_indexing(self):
        dense = self.table.dense()
        np.testing.assert_array_equal(self.table[2, 3, 4], dense[2, 3, 4])
        np.testing.assert_array_equal(self.table[:, 0, ::2, 1], dense[:, 0, ::2, 1])
        np.testing.assert_array_equal(self.table[-1], dense[-1])
        with self.assertRaises(IndexError):
            self.table[9]


class CellsTest(unittest.TestCase):
    def test_of_a_table(self):
        table = table_of_formula("gold-metal", "lower_corner", shape=(9, 8, 18), minimum_cosine=0.1)
        cells = table.cells
        self.assertEqual((cells.shape, cells.anchor, cells.minimum_cosine, len(cells)),
                         ((9, 8, 18), "lower_corner", 0.1, len(table)))
        np.testing.assert_array_equal(cells.directions(), table.directions())
        np.testing.assert_array_equal(cells.angles(), table.angles())
        np.testing.assert_array_equal(table.values[cells.numbers()], table.dense(fill=True))
        self.assertFalse(cells == gonio.Table(np.zeros((9, 8, 18, 3))).cells)

    def test_a_prior_is_evaluated_without_gonio(self):
        prior, samples = gonio.read_prior(), gonio.read_samples(MEASUREMENTS)
        fit = gonio.Decomposition(prior).fit(samples)
        y = prior.components @ fit.weights + prior.mean[:, None]
        c, reference = prior.cosine_weight[:, None], prior.reference[:, None]
        values = np.maximum((np.exp(y) * (reference * c + 0.001) - 0.001) / c, 0)
        wi, wo = np.split(prior.cells.directions(), 2, axis=1)
        np.testing.assert_allclose(values, fit(wi, wo), rtol=2e-4, atol=1e-5)


if __name__ == "__main__":
    unittest.main()
