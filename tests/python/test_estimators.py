import json
import pathlib
import subprocess
import tempfile
import threading
import time
import unittest
import warnings

import numpy as np

import gonio
from surroundings import MEASUREMENTS, PRIOR, TOOL, unit

WI, WO = unit(np.array([0.1, 0.6, 1.1]), np.zeros(3)), unit(np.array([0.3, 0.6, 0.2]), np.full(3, np.pi))


class PriorTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.prior = gonio.read_prior(PRIOR)

    def test_the_package_has_one(self):
        np.testing.assert_array_equal(gonio.read_prior().components, self.prior.components)

    def test_views(self):
        components = self.prior.components
        self.assertEqual(components.__array_interface__["data"], self.prior.components.__array_interface__["data"])
        self.assertEqual(components.shape, (len(self.prior.mean), len(self.prior)))
        self.assertFalse(components.flags.writeable)
        self.assertTrue((np.diff(self.prior.singular_values) <= 0).all())

    def test_weights_of_a_material(self):
        self.assertEqual(self.prior.weights_of(self.prior.names[0]).shape, (len(self.prior), 3))
        with self.assertRaisesRegex(gonio.Error, "the prior has no material 'cheese'"):
            self.prior.weights_of("cheese")

    @unittest.skipUnless(TOOL, "the tool is not beside the module")
    def test_wavelengths_are_the_channels(self):
        self.assertEqual(self.prior.wavelengths.shape, (0,))
        with tempfile.TemporaryDirectory() as folder:
            paints = pathlib.Path(folder) / "paints"
            paints.mkdir()
            for name, reflectance in (("dark", 0.05), ("light", 0.4)):
                samples = paints / (name + ".csv")
                rows = (f"{t},{t},90,{reflectance},{reflectance / 2},{reflectance / 3}\n" for t in range(5, 60, 10))
                samples.write_text("# quantity: brdf\ntheta_h,theta_d,phi_d,450nm,550nm,650nm\n" + "".join(rows))
                self.run_tool("reconstruct", "--spectra", samples, "--prior", PRIOR, "-o", samples.with_suffix(".bsdf"))
            spectral = pathlib.Path(folder) / "spectral.prior"
            self.run_tool("learn", "--spectra", "--rgl", paints, "--thin", "30", "60", "--components", "2", "-o",
                          spectral)
            prior = gonio.read_prior(spectral)
        np.testing.assert_array_equal(prior.wavelengths, [450, 550, 650])
        self.assertEqual(prior.weights_of("dark").shape, (2, 3))

    @staticmethod
    def run_tool(*arguments):
        subprocess.run([TOOL, *map(str, arguments)], check=True, capture_output=True)

    def test_a_file_keeps_it(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "my.prior"
            gonio.write_prior(path, self.prior)
            np.testing.assert_array_equal(gonio.read_prior(path).mean, self.prior.mean)


class DecompositionTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.prior = gonio.read_prior(PRIOR)
        cls.samples = gonio.read_samples(MEASUREMENTS)

    def test_first_program(self):
        paint = gonio.Decomposition(self.prior, eta=40.0).fit(self.samples)
        self.assertEqual(paint.weights.shape, (len(self.prior), 3))
        self.assertLess(max(paint.report["kkt_residual"]), 1e-6)
        truth = gonio.formula_material("red-paint")
        directions = gonio.Table(np.zeros((12, 12, 24, 3))).directions()
        wi, wo = directions[:, :3], directions[:, 3:]
        self.assertLess(np.median(np.abs(paint(wi, wo) / truth(wi, wo) - 1)), 0.15)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "paint.binary"
            gonio.write_merl(path, paint)
            np.testing.assert_array_equal(gonio.read_merl(path).values, paint.tabulate().values)

    def test_weights_written_through_a_view_count(self):
        samples = gonio.read_samples(MEASUREMENTS)
        fit = gonio.Decomposition(self.prior)
        samples.weights[5:] = 0
        few = fit.fit(samples)
        np.testing.assert_array_equal(few.weights, fit.fit(samples.subset(range(5))).weights)

    def test_a_brdf_of_weights(self):
        fit = gonio.Decomposition(self.prior).fit(self.samples)
        pairs = self.prior.cells.directions()[::997]
        wi, wo = pairs[:, :3], pairs[:, 3:]
        np.testing.assert_array_equal(self.prior.brdf(fit.weights)(wi, wo), fit(wi, wo))
        few = np.zeros_like(fit.weights)
        few[:5] = fit.weights[:5]
        np.testing.assert_array_equal(self.prior.brdf(fit.weights[:5])(wi, wo), self.prior.brdf(few)(wi, wo))
        for wrong in (np.zeros((len(self.prior) + 1, 3)), np.zeros((5, 2)), np.full((5, 3), np.nan)):
            with self.assertRaisesRegex(gonio.Error, "weights"):
                self.prior.brdf(wrong)

    def test_gradient_by_the_weights(self):
        prior, fit = self.prior, gonio.Decomposition(self.prior).fit(self.samples)
        rows = np.array([[5, 500], [20000, 50000]])
        pairs = prior.cells.directions()[rows]
        wi, wo = pairs[..., :3], pairs[..., 3:]
        gradient = fit.gradient(wi, wo)
        self.assertEqual(gradient.shape, (2, 2, 3, len(prior)))
        # The values are exp(y) (reference c + .001) / c less .001 / c.
        slope = fit(wi, wo) + 0.001 / prior.cosine_weight[rows][..., None]
        np.testing.assert_allclose(gradient, slope[..., None] * prior.components[rows][:, :, None], rtol=1e-4, atol=1e-9)
        self.assertEqual(np.abs(fit.gradient([0, 0, 1], [0, 0, -1])).max(), 0)

    def test_nan_written_through_a_view_is_refused(self):
        samples = gonio.read_samples(MEASUREMENTS)
        samples.values[3, 0] = np.nan
        with self.assertRaisesRegex(gonio.Error, "sample 4: a reflectance is not finite"):
            gonio.Decomposition(self.prior).fit(samples)

    def test_of_a_table(self):
        table = gonio.Table(np.full((12, 12, 24, 3), 0.2))
        grey = gonio.Decomposition(self.prior, eta=1e-3).fit(table)
        directions = table.directions()
        values = grey(directions[:, :3], directions[:, 3:])
        self.assertLess(np.median(np.abs(values / 0.2 - 1)), 0.1)

    def test_an_impossible_penalty_is_refused(self):
        with self.assertRaises(gonio.Error):
            gonio.Decomposition(self.prior, eta=-1.0)

    def test_other_threads_run_meanwhile(self):
        estimator, table = gonio.Decomposition(self.prior), gonio.formula_material("red-paint").tabulate()
        started, finished = threading.Event(), threading.Event()

        def work():
            started.set()
            estimator.fit(table)  # about a second
            finished.set()

        worker = threading.Thread(target=work)
        worker.start()
        started.wait()
        time.sleep(0.02)
        self.assertFalse(finished.is_set())
        worker.join()


class ReconstructedBrdfTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.estimator = gonio.Estimator(gonio.read_prior(PRIOR), noise=0.02)
        cls.paint = cls.estimator.fit(gonio.read_samples(MEASUREMENTS))

    def test_intervals_hold_the_value_and_widen(self):
        value = self.paint(WI, WO)
        low, high = self.paint.interval(WI, WO)
        lower, higher = self.paint.interval(WI, WO, 0.95)
        self.assertTrue((lower <= low).all() and (low <= value).all())
        self.assertTrue((value <= high).all() and (high <= higher).all())
        # Not quite that share of the value: the logarithm is of the value and a little more.
        np.testing.assert_allclose(high, value * (1 + self.paint.known_to(WI, WO)[:, None]), rtol=0.03)

    def test_a_wrong_sample_is_named(self):
        samples = gonio.read_samples(MEASUREMENTS)
        samples.values[5] *= 20
        fit = self.estimator.fit(samples)
        self.assertEqual(fit.rejected, [5])
        found = fit.contradicted[0]
        self.assertEqual(found.row, 5)
        self.assertLess(found.predicted[1], found.measured[1])
        self.assertGreater(found.probability, 0.75)
        self.assertIn("row 5", repr(found))

    def test_refusals(self):
        with self.assertRaisesRegex(gonio.Error, "a probability of 0.68 or 0.95, not of 0.5"):
            self.paint.interval(WI, WO, 0.5)
        with self.assertRaisesRegex(gonio.Error, "pair 0 of wi and wo is not above the horizon"):
            self.paint.known_to([0, 0, -1], [0, 0, 1])
        with self.assertRaisesRegex(gonio.Error, "variance is"):
            gonio.Estimator(gonio.read_prior(PRIOR), variance=-1)
        with self.assertWarnsRegex(UserWarning, "noise of 200 % is very large"):
            gonio.Estimator(gonio.read_prior(PRIOR), noise=2)
        with self.assertRaisesRegex(gonio.Error, "noise is"):
            gonio.Estimator(gonio.read_prior(PRIOR), noise=float("nan"))


class ReconstructTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.samples = gonio.read_samples(MEASUREMENTS)

    def tool(self, *arguments):
        """The table that the tool writes, and what it prints."""
        if not TOOL:
            self.skipTest("the tool was not built beside the module")
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "paint.binary"
            printed = subprocess.run(
                [TOOL, "reconstruct", str(MEASUREMENTS), "-o", str(path), "--json", *arguments],
                check=True, capture_output=True, text=True)
            return gonio.read_merl(path), json.loads(printed.stdout)

    def test_the_same_numbers_as_the_tool(self):
        for method, options, arguments in [
            ("pca", {}, []),
            ("pca", {"noise": 0.02, "reject": False}, ["--noise", "0.02", "--no-reject"]),
            ("pca", {"eta": 40}, ["--eta", "40"]),
            ("scattered", {"neighbours": 3}, ["--neighbours", "3"]),
        ]:
            with self.subTest(method=method, options=options):
                table, printed = self.tool("--method", method, *arguments)
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")  # scattered is further off than pca
                    ours = gonio.reconstruct(self.samples, method, **options)
                scale = np.abs(table.values).max()
                self.assertLess(np.abs(ours.table.values - table.values).max(), 1e-6 * scale)
                printed.pop("samples")
                self.assertEqual(ours.details, printed)

    def test_materials_of_the_rgl_database(self):
        with tempfile.TemporaryDirectory() as folder:
            for name in ("red-paint", "blue-rubber"):
                gonio.write_rgl(pathlib.Path(folder) / f"{name}.bsdf", gonio.formula_material(name))
            found = gonio.reconstruct(gonio.read_samples(MEASUREMENTS), "linear", rgl=[folder])
            directions = gonio.Table(np.zeros((12, 12, 24, 3))).directions()
            wi, wo = directions[:, :3], directions[:, 3:]
            error = np.abs(found.table(wi, wo) / gonio.formula_material("red-paint")(wi, wo) - 1)
            self.assertLess(np.median(error), 0.05)
            with self.assertRaisesRegex(gonio.Error, "rgl="):
                gonio.reconstruct(gonio.read_samples(MEASUREMENTS), "rbf", rgl=[folder])

    def test_a_prior_that_was_read(self):
        prior, copied = gonio.read_prior(), self.samples.subset(slice(12))
        for arguments in ({}, {"eta": 3.0}, {"method": "rbf", "metric": "log-relative"},
                          {"method": "linear", "exclude": prior.names[:3]}):
            with self.subTest(arguments=arguments), warnings.catch_warnings():
                warnings.simplefilter("ignore")
                by_file = gonio.reconstruct(copied, prior=PRIOR, **arguments)
                held = gonio.reconstruct(copied, prior=prior, **arguments)
                np.testing.assert_array_equal(held.table.values, by_file.table.values)
                self.assertEqual(held.sentence, by_file.sentence)

    def test_a_prior_is_not_ignored(self):
        with self.assertRaisesRegex(gonio.Error, "prior= needs method='pca' or soft-specular or"):
            gonio.reconstruct(self.samples, "scattered", prior=gonio.read_prior())

    def test_warnings_name_pythons_arguments(self):
        with self.assertWarnsRegex(UserWarning, "method='correction' needs at least .*: used method='pca' instead"):
            gonio.reconstruct(self.samples, "correction")

    def test_uncertainty_if_asked_for(self):
        self.assertIsNone(gonio.reconstruct(self.samples).uncertainty)
        known = gonio.reconstruct(self.samples, uncertainty=True).uncertainty
        self.assertGreater(known.values.min(), 0)

    def test_warnings_are_pythons(self):
        samples = gonio.read_samples(MEASUREMENTS)
        samples.values[5] *= 20
        with warnings.catch_warnings(record=True) as heard:
            warnings.simplefilter("always")
            found = gonio.reconstruct(samples)
        self.assertEqual([str(each.message) for each in heard], found.warnings)
        self.assertIs(heard[0].category, UserWarning)
        self.assertTrue(found.warnings[0].startswith("sample 6 disagrees and is left out"))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            with self.assertRaises(UserWarning):
                gonio.reconstruct(samples)

    def test_refusals(self):
        for arguments, sentence in [
            ({"method": "magic"}, "there is no method 'magic': expected one of pca, "),
            ({"method": "scattered", "noise": 0.1}, "noise= needs method='pca', not method='scattered'"),
            ({"noise": -1.0}, "noise=-1.0: expected at least 0"),
            ({"discrepancy": 11.0}, "discrepancy=11.0: expected 0 to 10"),
            ({"noise": float("nan")}, "noise=nan: expected at least 0"),
            ({"eta": "many"}, "eta= needs a positive number, gcv or loo, not 'many'"),
            ({"solver": "nnls"}, "solver='nnls' finds weights of at least 0"),
            ({"noise": 0.1, "eta": 2.0}, "noise= and eta= exclude each other: give one of them"),
            ({"misplaced_degrees": 1.0, "solver": "lasso"},
             "misplaced_degrees= needs solver='tikhonov', and noise= or a number for eta="),
            ({"reject": False, "eta": 2.0, "uncertainty": True},
             "reject=False, --residuals, --report, uncertainty=True and --uncertainty-image need a discrepancy"),
            ({"as_printed": True}, "as_printed=True needs method='correction', not method='pca'"),
            ({"lambda_share": 0.1, "method": "rbf"}, "lambda_share= needs method='pca' or linear"),
            ({"method": "soft-specular", "prior": gonio.read_prior()},
             "method='soft-specular' needs prior= as a file, written by gonio learn --split"),
            ({"prior": "nowhere--seed.prior"}, "nowhere--seed.prior"),
        ]:
            with self.subTest(arguments=arguments), self.assertRaises(gonio.Error) as raised:
                gonio.reconstruct(self.samples, **arguments)
            self.assertTrue(str(raised.exception).startswith(sentence), str(raised.exception))


if __name__ == "__main__":
    unittest.main()
