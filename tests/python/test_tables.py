import gc
import pathlib
import tempfile
import unittest

import numpy as np

import gonio
from surroundings import random_pairs, table_of_formula, unit


class TableTest(unittest.TestCase):
    def test_values_are_the_memory_of_the_table(self):
        table = gonio.Table()
        first, second = table.values, table.values
        self.assertEqual(first.dtype, np.float32)
        self.assertEqual(first.shape, (len(table), 3))
        self.assertEqual(first.__array_interface__["data"], second.__array_interface__["data"])
        first[:, 1] = 0.25
        np.testing.assert_array_equal(table([0, 0, 1], [0, 0, 1]), [0, 0.25, 0])

    def test_a_view_outlives_the_name_of_its_table(self):
        values = gonio.formula_material("red-paint").tabulate().values
        before = values.copy()
        gc.collect()
        np.testing.assert_array_equal(values, before)

    def test_a_copy_has_memory_of_its_own(self):
        table = gonio.Table()
        table.copy().values[:] = 1
        self.assertEqual(table.values.max(), 0)

    def test_dense_and_back(self):
        table = gonio.formula_material("red-paint").tabulate()
        dense = table.dense()
        self.assertEqual(dense.shape, table.shape + (3,))
        self.assertEqual(np.isfinite(dense[..., 0]).sum(), len(table))
        np.testing.assert_array_equal(gonio.Table(dense).values, table.values)

    def test_directions_are_those_of_the_angles(self):
        table = gonio.Table(np.zeros((9, 9, 18, 3)))
        directions, angles = table.directions(), table.angles()
        half = directions[:, :3] + directions[:, 3:]
        half /= np.linalg.norm(half, axis=1, keepdims=True)
        np.testing.assert_allclose(np.arccos(half[:, 2]), angles[:, 0], atol=1e-6)
        np.testing.assert_allclose(np.arccos((directions[:, :3] * half).sum(axis=1)), angles[:, 1], atol=1e-6)

    def test_files_keep_every_value(self):
        table = gonio.formula_material("gold").tabulate() if "gold" in gonio.formula_material_names() else None
        table = table or gonio.formula_material(gonio.formula_material_names()[0]).tabulate()
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "table.binary"
            gonio.write_merl(path, table)
            np.testing.assert_array_equal(gonio.read_merl(path).values, table.values)
            gonio.write_npy(path.with_suffix(".npy"), table)
            dense = table.dense()
            stored = np.load(path.with_suffix(".npy"))
            valid = np.isfinite(dense)
            np.testing.assert_array_equal(stored[valid], dense[valid])


class AnchorTest(unittest.TestCase):
    def test_a_file_keeps_it(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "table.binary"
            for anchor in ("centre", "lower_corner"):
                for minimum_cosine in (0, 0.05):
                    table = table_of_formula("gold-metal", anchor, minimum_cosine=minimum_cosine)
                    gonio.write_merl(path, table)
                    again = gonio.read_merl(path)
                    self.assertEqual(again.anchor, anchor)
                    self.assertAlmostEqual(again.minimum_cosine, minimum_cosine, delta=0.002)
                    np.testing.assert_array_equal(again.values, table.values)

    def test_values_were_taken_there(self):
        for anchor, first in (("centre", 0.5), ("lower_corner", 0)):
            table = gonio.Table(np.zeros((9, 9, 18, 3)), anchor=anchor)
            self.assertEqual(table.anchor, anchor)
            np.testing.assert_allclose(table.angles()[0], [(first / 9) ** 2 * np.pi / 2, first / 9 * np.pi / 2,
                                                           first / 18 * np.pi])

    def test_both_kinds_of_table_are_of_the_same_material(self):
        wi, wo = random_pairs(5000, smallest_cosine=0.1)
        truth = gonio.formula_material("gold-metal")(wi, wo)
        for anchor in ("centre", "lower_corner"):
            table = table_of_formula("gold-metal", anchor, shape=(90, 90, 180))
            self.assertLess(np.median(np.abs(table(wi, wo) / truth - 1)), 2e-3)

    def test_dense_and_back(self):
        for anchor in ("centre", "lower_corner"):
            table = table_of_formula("gold-metal", anchor, minimum_cosine=0.02)
            again = gonio.Table(table.dense(), anchor=table.anchor, minimum_cosine=table.minimum_cosine)
            np.testing.assert_array_equal(again.values, table.values)

    def test_an_array_in_a_file_has_values_at_centres(self):
        wi, wo = random_pairs(5000, smallest_cosine=0.1)
        table = table_of_formula("gold-metal", "lower_corner", shape=(90, 90, 180))
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "table.npy"
            gonio.write_npy(path, table)
            stored = gonio.Table(np.load(path))
        self.assertLess(np.median(np.abs(stored(wi, wo) / table(wi, wo) - 1)), 3e-3)

    def test_filled(self):
        table = table_of_formula("gold-metal", "lower_corner")
        dense, filled = table.dense(), table.dense(fill=True)
        known = np.isfinite(dense)
        np.testing.assert_array_equal(filled[known], dense[known])
        below = ~known[1:, ..., 0] & np.isfinite(filled[1:, ..., 0])
        self.assertEqual(below.sum(), (~known[1:, ..., 0]).sum())
        np.testing.assert_array_equal(filled[1:][below], filled[:-1][below])

    def test_refusals(self):
        values = np.zeros((9, 9, 18, 3))
        for arguments, sentence in [
            ({"anchor": "corner"}, "anchor is 'corner': expected 'centre' or 'lower_corner'"),
            ({"minimum_cosine": 1}, "minimum_cosine is 1.0: expected at least 0 and less than 1"),
            ({"minimum_cosine": np.nan}, "minimum_cosine is nan: expected at least 0 and less than 1"),
        ]:
            with self.subTest(sentence=sentence), self.assertRaises(gonio.Error) as raised:
                gonio.Table(values, **arguments)
            self.assertEqual(str(raised.exception), sentence)


class EvaluationTest(unittest.TestCase):
    def setUp(self):
        self.paint = gonio.formula_material("red-paint")

    def test_shapes(self):
        wo = unit(np.full((4, 5), 0.3), np.linspace(0, 3, 20).reshape(4, 5))
        one = np.array([0.0, 0.0, 1.0])
        self.assertEqual(self.paint(one, one).shape, (3,))
        self.assertEqual(self.paint(one, wo).shape, (4, 5, 3))
        np.testing.assert_array_equal(self.paint(one, wo), self.paint(np.broadcast_to(one, wo.shape), wo))

    def test_any_layout_and_type_is_read(self):
        wo = unit(np.linspace(0, 1.2, 7), np.zeros(7))
        expected = self.paint([0, 0, 1], wo)
        np.testing.assert_array_equal(self.paint([0, 0, 1], np.asfortranarray(wo)), expected)
        np.testing.assert_array_equal(self.paint([0, 0, 1], wo[::2]), expected[::2])
        np.testing.assert_allclose(self.paint([0, 0, 1], wo.astype(np.float32)), expected, rtol=1e-5)

    def test_the_number_of_threads_changes_nothing(self):
        generator = np.random.default_rng(1)
        wi, wo = (unit(generator.uniform(0, 1.5, 5000), generator.uniform(0, 6, 5000)) for _ in range(2))
        np.testing.assert_array_equal(self.paint(wi, wo, threads=1), self.paint(wi, wo, threads=3))

    def test_below_the_horizon_is_black(self):
        np.testing.assert_array_equal(self.paint([0, 0, -1], [0, 0, 1]), 0)

    def test_bad_directions_are_refused(self):
        up = [0, 0, 1]
        for wi, sentence in [
            ([0, 0, 2], "vector 0 of wi has length 2.0: expected 1"),
            ([0, 0, np.nan], "wi[2] is nan: expected finite numbers"),
            ([[0, 0, 1], [0, np.inf, 1]], "wi[1, 1] is inf: expected finite numbers"),
            ([0, 1], "wi has shape (2,): expected (..., 3), unit vectors"),
            (1.0, "wi has shape (): expected (..., 3), unit vectors"),
            ("up", "wi is not an array of numbers"),
            ([[0, 0, 1]] * 3, "wi has 3 vectors and wo has 2: expected arrays of the same shape, "
                              "or a single vector beside an array"),
        ]:
            with self.subTest(sentence=sentence), self.assertRaises(gonio.Error) as raised:
                self.paint(wi, [up] * 2 if np.shape(wi) == (3, 3) else up)
            self.assertEqual(str(raised.exception), sentence)


class RefusalTest(unittest.TestCase):
    def refused(self, sentence, call, *arguments):
        with self.assertRaises(gonio.Error) as raised:
            call(*arguments)
        self.assertEqual(str(raised.exception), sentence)

    def test_an_error_is_a_value_error(self):
        self.assertTrue(issubclass(gonio.Error, ValueError))
        self.assertEqual(gonio.Error.__module__, "gonio")

    def test_tables_of_other_shapes(self):
        self.refused("values has shape (9, 9, 18): expected (theta_h, theta_d, phi_d, 3)", gonio.Table,
                     np.zeros((9, 9, 18)))
        self.refused("values is not an array of numbers", gonio.Table, "table")

    def test_a_hole_above_the_horizon(self):
        values = np.zeros((9, 9, 18, 3))
        values[2, 1, 0, 1] = np.nan
        self.refused("values[2, 1, 0, 1] is nan: expected finite numbers above the horizon", gonio.Table, values)

    def test_files_that_are_not_there(self):
        for read in (gonio.read_merl, gonio.read_rgl, gonio.read_samples, gonio.read_prior, gonio.read_hdr):
            with self.subTest(read=read.__name__), self.assertRaisesRegex(gonio.Error, "nowhere"):
                read("nowhere.binary")


if __name__ == "__main__":
    unittest.main()
