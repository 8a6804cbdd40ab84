"""Samples with wavelengths, and what an estimator makes of them."""

import copy
import pathlib
import pickle
import tempfile
import unittest

import numpy as np

import gonio
from surroundings import unit

WAVELENGTHS = np.arange(400.0, 701.0, 20.0)
RNG = np.random.default_rng(3)
THETA_I, THETA_O, PHI = RNG.uniform(0.0, 1.3, 20), RNG.uniform(0.0, 1.3, 20), RNG.uniform(0.0, 2 * np.pi, 20)
DIRECTIONS = np.hstack([unit(THETA_I, 0 * PHI), unit(THETA_O, PHI)])


def paint():
    """A reddish paint with a broad gloss: 20 spectra."""
    half = DIRECTIONS[:, :3] + DIRECTIONS[:, 3:]
    gloss = 0.5 * (half[:, 2] / np.linalg.norm(half, axis=1)) ** 200
    return 0.02 + 0.1 / (1 + np.exp((580 - WAVELENGTHS) / 20)) + gloss[:, None]


class SpectraTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.samples = gonio.Samples(DIRECTIONS, paint(), wavelengths=WAVELENGTHS)
        cls.estimator = gonio.Estimator(gonio.read_prior())
        cls.fit = cls.estimator.fit(cls.samples)

    def test_samples_keep_their_wavelengths(self):
        np.testing.assert_array_equal(self.samples.values, paint())
        np.testing.assert_array_equal(self.samples.wavelengths, WAVELENGTHS)
        np.testing.assert_allclose(self.samples.directions, DIRECTIONS, atol=1e-15)
        np.testing.assert_array_equal(self.samples.weights, np.ones((20, 3)))
        self.assertEqual(repr(self.samples)[:38], "<gonio.Samples: 20 of 16 wavelengths, ")
        self.assertIsNone(self.samples.colours().wavelengths)
        self.assertEqual(self.samples.colours("A").values.shape, (20, 3))

    def test_rows_copies_and_weights(self):
        self.assertEqual(len(self.samples[3]), 1)
        np.testing.assert_array_equal(self.samples[-2].values, paint()[-2:-1])
        np.testing.assert_array_equal(self.samples[2:9].values, paint()[2:9])
        self.assertEqual(sum(len(one) for one in self.samples), 20)
        for again in (copy.deepcopy(self.samples), pickle.loads(pickle.dumps(self.samples))):
            np.testing.assert_array_equal(again.values, self.samples.values)
            np.testing.assert_array_equal(again.wavelengths, WAVELENGTHS)
            np.testing.assert_array_equal(again.angles, self.samples.angles)
        written = gonio.Samples(DIRECTIONS, paint(), np.full(20, 0.5), WAVELENGTHS)
        np.testing.assert_array_equal(written.weights, np.full((20, 3), 0.5))
        written.values[4, 7] = 0.25
        self.assertEqual(written[4].values[0, 7], 0.25)

    def test_files_keep_spectra_if_asked(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "paint.csv"
            gonio.write_samples(path, self.samples)
            np.testing.assert_allclose(gonio.read_samples(path, spectra=True).values, paint(), rtol=1e-12)
            self.assertIsNone(gonio.read_samples(path).wavelengths)
            gonio.write_samples(path, self.samples.colours())
            with self.assertRaisesRegex(gonio.Error, "paint.csv: has no spectra"):
                gonio.read_samples(path, spectra=True)

    def test_what_cannot_be_is_refused(self):
        for arguments, words in [
            ((DIRECTIONS, paint(), None, WAVELENGTHS[:5]), "values"),
            ((DIRECTIONS, paint()[:7], None, WAVELENGTHS), "values has 7 rows"),
            ((DIRECTIONS, paint(), np.ones((20, 3)), WAVELENGTHS), "weights"),
            ((DIRECTIONS, paint(), None, WAVELENGTHS[::-1]), "wavelength 2"),
            ((DIRECTIONS, paint()[:, :1], None, [633.0]), "expected at least two"),
            ((DIRECTIONS, paint() * np.nan, None, WAVELENGTHS), "values"),
        ]:
            with self.assertRaisesRegex(gonio.Error, words):
                gonio.Samples(*arguments)
        with self.assertRaisesRegex(gonio.Error, "expected 'D65' or 'A'"):
            self.samples.colours("F2")

    def test_a_fit_has_the_spectra_of_its_samples(self):
        np.testing.assert_array_equal(self.fit.wavelengths, WAVELENGTHS)
        values = self.fit.values(DIRECTIONS[:, :3], DIRECTIONS[:, 3:])
        self.assertEqual(values.shape, (20, 16))
        self.assertLess(np.median(np.abs(values / paint() - 1)), 0.05)
        self.assertEqual(self.fit(DIRECTIONS[:, :3], DIRECTIONS[:, 3:]).shape, (20, 3))
        self.assertEqual(self.fit.spikes, [])
        linear = gonio.Decomposition(gonio.read_prior(), 5.0).fit(self.samples)
        self.assertEqual(linear.weights.shape[1], 16)
        self.assertEqual(linear.values(DIRECTIONS[0, :3], DIRECTIONS[0, 3:]).shape, (16,))
        coloured = self.estimator.fit(self.samples.colours())
        self.assertIsNone(coloured.wavelengths)
        with self.assertRaisesRegex(gonio.Error, "no wavelengths"):
            coloured.tabulate_spectra()

    def test_a_spike_is_replaced_and_listed(self):
        values = paint()
        values[6, 9] *= 8
        fit = self.estimator.fit(gonio.Samples(DIRECTIONS, values, wavelengths=WAVELENGTHS))
        self.assertEqual([(s.row, s.band) for s in fit.spikes], [(6, 9)])
        self.assertEqual(fit.spikes[0].measured, values[6, 9])
        self.assertLess(abs(fit.spikes[0].replaced_by / paint()[6, 9] - 1), 0.2)
        self.assertIn("row 6, band 9", repr(fit.spikes[0]))
        kept = gonio.Estimator(gonio.read_prior(), reject=False)
        self.assertEqual(kept.fit(gonio.Samples(DIRECTIONS, values, wavelengths=WAVELENGTHS)).spikes, [])

    def test_tables_of_spectra(self):
        table = self.fit.tabulate_spectra(cells=gonio.Table(np.zeros((30, 15, 20, 3))).cells)
        self.assertEqual(table.values.shape, (len(table), 16))
        np.testing.assert_array_equal(table.wavelengths, WAVELENGTHS)
        wi, wo = DIRECTIONS[:, :3], DIRECTIONS[:, 3:]
        self.assertEqual(table(wi, wo).shape, (20, 16))
        self.assertLess(np.median(np.abs(table(wi, wo) / self.fit.values(wi, wo) - 1)), 0.05)
        self.assertEqual(table.colours().cells.shape, (30, 15, 20))
        again = pickle.loads(pickle.dumps(table))
        np.testing.assert_array_equal(again.values, table.values)
        self.assertEqual(repr(table)[:37], "<gonio.SpectralTable: 16 wavelengths,")
        with tempfile.TemporaryDirectory() as folder:
            gonio.write_rgl(pathlib.Path(folder) / "paint.bsdf", table)
            read = gonio.read_rgl(pathlib.Path(folder) / "paint.bsdf")
        np.testing.assert_allclose(np.median(read(wi, wo) / table.colours()(wi, wo)), 1.0, atol=0.05)


if __name__ == "__main__":
    unittest.main()
