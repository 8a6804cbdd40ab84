import pathlib
import tempfile
import unittest

import numpy as np

import gonio
from surroundings import MEASUREMENTS, unit

DIRECTIONS = np.hstack([unit(np.array([0.2, 0.5]), np.array([0.0, 1.0])), unit(np.array([0.7, 0.1]), np.array([2.0, 3.0]))])


class SamplesTest(unittest.TestCase):
    def test_a_block_of_a_file_with_several(self):
        tree = (
            "<WindowElement><DataDefinition><IncidentDataStructure>TensorTree3</IncidentDataStructure></DataDefinition>"
            "<WavelengthData><Wavelength>Solar</Wavelength><WavelengthDataBlock><WavelengthDataDirection>Reflection Back"
            "</WavelengthDataDirection><AngleBasis>LBNL/Shirley-Chiu</AngleBasis><ScatteringData>{ .25 }"
            "</ScatteringData></WavelengthDataBlock></WavelengthData></WindowElement>"
        )
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "tree.xml"
            path.write_text(tree)
            self.assertEqual(len(gonio.read_samples(path, side="back", band="solar")), 256)
            with self.assertRaisesRegex(gonio.Error, "Reflection Front"):
                gonio.read_samples(path, side="front", band="Solar")
        with self.assertRaisesRegex(gonio.Error, "band=.*Klems"):
            gonio.read_samples(MEASUREMENTS, band="Solar")

    def test_columns_are_views_of_the_same_memory(self):
        samples = gonio.read_samples(MEASUREMENTS)
        address = samples.values.__array_interface__["data"][0]
        self.assertEqual(address, samples.values.__array_interface__["data"][0])
        # The columns of one sample stand beside each other, those of the next one stride further.
        stride = samples.values.strides[0]
        start = samples.directions.__array_interface__["data"][0]
        for column in (samples.angles, samples.values, samples.weights):
            self.assertEqual(column.strides[0], stride)
            self.assertLess(column.__array_interface__["data"][0] - start, stride)

    def test_what_is_written_is_in_the_samples(self):
        samples = gonio.Samples(DIRECTIONS, [0.1, 0.2])
        samples.values[1] = [1, 2, 3]
        samples.weights[0] = 0.5
        np.testing.assert_array_equal(samples.values, [[0.1] * 3, [1, 2, 3]])
        np.testing.assert_array_equal(samples.weights, [[0.5] * 3, [1] * 3])

    def test_files_of_other_columns_and_quantities(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "paint.csv"
            path.write_text("theta_i;phi_i;Winkel;phi_o;value\n30;0;45;180;62,8\n")
            samples = gonio.read_samples(path, quantity="percent", columns={"theta_o": "Winkel"})
            np.testing.assert_allclose(samples.values, [[0.628 / np.pi] * 3], rtol=1e-6)
            with self.assertRaisesRegex(gonio.Error, "quantity"):
                gonio.read_samples(path, columns={"theta_o": "Winkel"})

    def test_directions_cannot_be_written(self):
        samples = gonio.Samples(DIRECTIONS, [0.1, 0.2])
        for column in (samples.directions, samples.angles):
            with self.assertRaises(ValueError):
                column[0] = 0

    def test_directions_are_kept(self):
        np.testing.assert_allclose(gonio.Samples(DIRECTIONS, [0.1, 0.2]).directions, DIRECTIONS, atol=1e-15)

    def test_angles_and_vectors_say_the_same(self):
        by_vectors = gonio.Samples(DIRECTIONS, [0.1, 0.2])
        by_angles = gonio.Samples(by_vectors.angles, [0.1, 0.2])
        np.testing.assert_array_equal(by_angles.angles, by_vectors.angles)

    def test_a_file_keeps_them(self):
        samples = gonio.read_samples(MEASUREMENTS)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "samples.csv"
            gonio.write_samples(path, samples)
            again = gonio.read_samples(path)
        self.assertEqual(len(again), len(samples))
        np.testing.assert_array_equal(again.values, samples.values)
        np.testing.assert_allclose(again.angles, samples.angles, atol=1e-12)

    def test_rows_are_chosen_as_numpy_does(self):
        samples = gonio.read_samples(MEASUREMENTS)
        mask = np.ones(len(samples), bool)
        mask[[3, 7]] = False
        for rows in (
            mask, list(mask), ~mask, np.zeros(len(samples), bool), slice(None), slice(None, None, 5), slice(-3, None),
            slice(30, 2, -4), [3, 1], (3, 1), [3, 3], [-1, 0, -20], np.array([19, 2], np.uint8), np.arange(6)[::-2],
            np.array([2**64 - 1], np.uint64), range(2, 9, 3), [],
        ):
            index = list(rows) if isinstance(rows, (tuple, range)) else rows
            expected = samples.values[np.array(index, int) if isinstance(index, list) and not index else index]
            with self.subTest(rows=rows):
                np.testing.assert_array_equal(samples.subset(rows).values, expected)
                if not isinstance(rows, tuple):
                    np.testing.assert_array_equal(samples[rows].values, expected)

    def test_all_of_a_sample_is_chosen(self):
        samples = gonio.Samples(DIRECTIONS, [0.1, 0.2], [[1, 2, 3], [4, 5, 6]])
        chosen = samples.subset([True, False])
        np.testing.assert_array_equal(chosen.directions, samples.directions[:1])
        np.testing.assert_array_equal(chosen.weights, [[1, 2, 3]])
        chosen.values[:] = 7
        self.assertEqual(samples.values.max(), 0.2)

    def test_a_single_index(self):
        samples = gonio.read_samples(MEASUREMENTS)
        for row in (0, 3, -1, -20, np.int32(4), np.uint8(5)):
            np.testing.assert_array_equal(samples[row].values, samples.values[[row]])
        np.testing.assert_array_equal(samples[...].values, samples.values)
        self.assertEqual([float(each.values[0, 0]) for each in samples], list(samples.values[:, 0]))
        for row in (20, -21, 2**70):
            with self.assertRaises(IndexError):
                samples[row]

    def test_rows_that_are_refused(self):
        samples = gonio.read_samples(MEASUREMENTS)
        of_type = ": expected whole numbers, True and False for each sample, or a slice"
        for rows, sentence in [
            (np.ones(5, bool), "rows is a mask of shape (5,): expected (20,), one value for each sample"),
            (np.ones((20, 1), bool), "rows is a mask of shape (20, 1): expected (20,), one value for each sample"),
            (True, "rows is a mask of shape (): expected (20,), one value for each sample"),
            ([0, 20], "there is no sample in row 20: expected rows from -20 to 19"),
            ([0, -21], "there is no sample in row -21: expected rows from -20 to 19"),
            ([1.0], "rows is of type float64" + of_type),
            (["1"], "rows is of type <U1" + of_type),
            (None, "rows is of type object" + of_type),
            ({1, 2}, "rows is of type object" + of_type),
            ([[1, 2]], "rows has shape (1, 2): expected (n,)"),
            ([[1, 2], [3]], "rows is not an array of numbers"),
        ]:
            for choose in (samples.subset, samples.__getitem__):
                with self.subTest(rows=rows, choose=choose.__name__), self.assertRaises(gonio.Error) as raised:
                    choose(rows)
                self.assertEqual(str(raised.exception), sentence)
        with self.assertRaisesRegex(gonio.Error, r"rows has shape \(\): expected \(n,\)"):
            samples.subset(3)
        with self.assertRaisesRegex(gonio.Error, "samples have one axis"):
            samples[0, 1]

    def test_none(self):
        with self.assertRaisesRegex(gonio.Error, "there are no samples"):
            gonio.Samples(np.zeros((0, 6)), [])

    def test_refusals(self):
        values = [0.1, 0.2]
        tilted = DIRECTIONS.copy()
        tilted[1, 5] *= -1
        long = DIRECTIONS.copy()
        long[1, :3] = [0, 0, 2]
        for directions, given, weights, sentence in [
            (DIRECTIONS[:, :5], values, None, "directions has shape (2, 5): expected (n, 6) or (n, 3)"),
            (DIRECTIONS, [[1, 2]] * 2, None, "values has shape (2, 2): expected (n, 3) or (n,)"),
            (DIRECTIONS, [1, 2, 3], None, "values has 3 rows, directions has 2: expected the same number"),
            (DIRECTIONS, [1, np.nan], None, "values[1] is nan: expected finite numbers"),
            (DIRECTIONS, values, [1, -1], "sample 2: the weight must be finite and not negative"),
            (long, values, None, "directions[1]: wi has length 2.0, expected 1"),
            ([[12.5, 20, 0]], [1], None,
             "directions[0] has theta_h 12.5: expected radians of at least 0 and less than pi/2"),
            (np.repeat(DIRECTIONS[:, :3], 2, axis=0), [1] * 4, None,
             "directions looks like unit vectors: expected light and viewer side by side, np.hstack([wi, wo]), or "
             "theta_h, theta_d and phi_d in radians"),
            ([[0.1, 0.2, 90]], [1], None, "directions[0] has phi_d 90.0: expected radians from -2 pi to 2 pi"),
        ]:
            with self.subTest(sentence=sentence), self.assertRaises(gonio.Error) as raised:
                gonio.Samples(directions, given, weights)
            self.assertEqual(str(raised.exception), sentence)
        with self.assertRaisesRegex(gonio.Error, r"directions\[1\]: a direction is at or below the horizon"):
            gonio.Samples(tilted, values)
        with self.assertRaisesRegex(gonio.Error, "there is no sample in row 2"):
            gonio.Samples(DIRECTIONS, values).subset([2])


if __name__ == "__main__":
    unittest.main()
