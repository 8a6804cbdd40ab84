"""Maps of spatially varying BRDFs, which `gonio svbrdf` writes."""

import json
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

import gonio
from surroundings import TOOL

ROWS, COLUMNS = 4, 6
BESIDE = (1, 2)  # the texel that is not of the sample


def write_map(folder):
    """Four images of texels between two materials, and the map that the tool makes of them; the path and the images."""
    angles = np.radians([[5, 10, 30], [20, 30, 90], [1, 50, 60], [50, 15, 40]])
    pairs = gonio.Samples(angles, np.ones(4)).directions
    wi, wo = pairs[:, :3], pairs[:, 3:]
    share = np.linspace(0, 1, ROWS * COLUMNS).reshape(ROWS, COLUMNS, 1)
    one, other = (gonio.formula_material(name)(wi, wo) for name in ("red-paint", "blue-rubber"))
    images = np.stack([(1 - share) * one[i] + share * other[i] for i in range(4)]).astype(np.float32)
    entries = []
    for i in range(4):
        np.save(folder / f"{i}.npy", images[i])
        names = ("theta_h", "theta_d", "phi_d")
        entries.append({"image": f"{i}.npy", **dict(zip(names, np.degrees(angles[i]).tolist()))})
    mask = np.ones((ROWS, COLUMNS, 3), np.float32)
    mask[BESIDE] = 0
    gonio.write_png(folder / "mask.png", mask)
    (folder / "images.json").write_text(json.dumps({"quantity": "brdf", "mask": "mask.png", "images": entries}))
    subprocess.run([TOOL, "svbrdf", folder / "images.json", "-o", folder / "map.gsv"], check=True, capture_output=True)
    return folder / "map.gsv", images


@unittest.skipUnless(TOOL, "the tool is not beside the module")
class MapTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.path, cls.images = write_map(pathlib.Path(cls.folder.name))
        cls.map = gonio.read_map(cls.path)

    def test_texels_are_what_was_seen(self):
        self.assertEqual(self.map.shape, (ROWS, COLUMNS))
        self.assertEqual(self.map.directions.shape, (4, 6))
        wi, wo = self.map.directions[:, :3], self.map.directions[:, 3:]
        for row, column in ((0, 0), (3, 5), (2, 3)):
            seen = self.map.brdf(row, column)(wi, wo)
            expected = self.images[:, row, column]
            np.testing.assert_allclose(seen, expected, rtol=0.15, atol=0.01)

    def test_weights_are_those_of_the_functions(self):
        weights = self.map.functions @ self.map.weights[2, 3].astype(float).T
        np.testing.assert_allclose(self.map.brdf(2, 3).weights, weights, rtol=1e-6)
        self.assertEqual(self.map.weights.dtype, np.float16)

    def test_a_texel_beside_the_sample(self):
        self.assertEqual(self.map.uncertainty[BESIDE], 0)
        self.assertEqual((self.map.uncertainty > 0).sum(), ROWS * COLUMNS - 1)
        with self.assertRaisesRegex(gonio.Error, "row 1, column 2 is outside the sample"):
            self.map.brdf(*BESIDE)

    def test_refusals(self):
        for row, column in ((ROWS, 0), (0, COLUMNS), (-1, 0)):
            with self.assertRaisesRegex(IndexError, "4 x 6 texels"):
                self.map.brdf(row, column)
        with self.assertRaises(gonio.Error):
            gonio.read_map(self.path.with_name("images.json"))
        damaged = bytearray(self.path.read_bytes())
        damaged[-20] ^= 1
        other = self.path.with_name("damaged.gsv")
        other.write_bytes(bytes(damaged))
        with self.assertRaises(gonio.Error):
            gonio.read_map(other)


if __name__ == "__main__":
    unittest.main()
