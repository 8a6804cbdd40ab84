import os
import pathlib
import signal
import tempfile
import threading
import unittest

import numpy as np

import gonio
from surroundings import unit


class SphereTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.white = gonio.Table(np.full((30, 30, 60, 3), 1 / np.pi))

    def test_a_white_sphere_has_the_mean_luminance_one(self):
        picture = gonio.render_sphere(self.white, size=64)
        self.assertEqual((picture.shape, picture.dtype), ((64, 64, 3), np.float32))
        disc = np.pi / 4
        self.assertAlmostEqual(float(picture.mean()) / disc, 1, delta=0.02)

    def test_nobody_else_holds_the_picture(self):
        picture = gonio.render_sphere(self.white, size=16)
        self.assertTrue(picture.flags.writeable)
        before = gonio.render_sphere(self.white, size=16)
        picture[:] = 0
        self.assertGreater(before.max(), 0)

    def test_a_furnace(self):
        picture = gonio.render_sphere_in(self.white, np.ones((8, 16, 3)), size=32, white=0.5)
        self.assertAlmostEqual(float(picture[16, 16, 1]), 0.5, delta=0.02)

    def test_the_same_seed_gives_the_same_bytes(self):
        light = np.random.default_rng(1).uniform(0, 1, (8, 16, 3))
        one, other = (gonio.render_sphere_in(self.white, light, size=16, seed=3, threads=n) for n in (1, 3))
        np.testing.assert_array_equal(one, other)

    def test_control_c_ends_it(self):
        timer = threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            gonio.render_sphere_in(self.white, np.ones((8, 16, 3)), size=256, quality=5000)
        timer.join()

    def test_png(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "sphere.png"
            gonio.write_png(path, gonio.render_sphere(self.white, size=16))
            self.assertEqual(path.read_bytes()[:4], b"\x89PNG")

    def test_refusals(self):
        with self.assertRaisesRegex(gonio.Error, "size is 4: expected 8 to 4096"):
            gonio.render_sphere(self.white, size=4)
        with self.assertRaisesRegex(gonio.Error, r"environment has shape \(8, 16\)"):
            gonio.render_sphere_in(self.white, np.ones((8, 16)))
        with self.assertRaises(gonio.Error):
            gonio.render_sphere_in(self.white, -np.ones((8, 16, 3)))


class CompareTest(unittest.TestCase):
    def test_of_a_darker_table(self):
        table = gonio.formula_material("red-paint").tabulate()
        darker = table.copy()
        darker.values[:] *= 0.8
        errors = gonio.compare(darker, table)
        np.testing.assert_allclose(errors["peak_ratio"], [0.8] * 3, rtol=1e-6)
        self.assertGreater(errors["delta_e_lights"], 1)
        readings = errors["readings"]
        self.assertAlmostEqual(readings["estimate"]["gloss"]["60"] / readings["truth"]["gloss"]["60"], 0.8, 5)
        self.assertEqual(readings["truth"], gonio.instrument_readings(table))

    def test_readings_of_a_grey_diffuser(self):
        grey = gonio.formula_material("red-paint").tabulate()
        grey.values[:] = 0.5 / np.pi
        readings = gonio.instrument_readings(grey)
        self.assertAlmostEqual(readings["luminous_reflectance_8"], 0.5, 2)
        self.assertAlmostEqual(readings["gloss"]["60"], 1.2426, 2)
        self.assertEqual([each["aspecular"] for each in readings["colours"]], [15, 25, 45, 75, 110])
        for each in readings["colours"]:
            self.assertAlmostEqual(each["L"], 76.07, 1)
        with self.assertRaisesRegex(gonio.Error, "brdf is 'paint': expected a BRDF"):
            gonio.instrument_readings("paint")


if __name__ == "__main__":
    unittest.main()
