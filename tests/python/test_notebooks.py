"""The notebooks of examples/python/notebooks run, and keep what their cells print and draw now."""

import importlib.util
import json
import unittest

from surroundings import SOURCE

FOLDER = SOURCE / "examples" / "python" / "notebooks"
MATPLOTLIB = importlib.util.find_spec("matplotlib")


def runner():
    """examples/python/notebooks/run.py as a module."""
    spec = importlib.util.spec_from_file_location("run", FOLDER / "run.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@unittest.skipUnless(MATPLOTLIB, "matplotlib is not here")
class NotebooksTest(unittest.TestCase):
    def test_outputs(self):
        notebooks = sorted(FOLDER.glob("*.ipynb"))
        self.assertTrue(notebooks)
        for path in notebooks:
            with self.subTest(path.name):
                self.assertLess(path.stat().st_size, 1_000_000)
                kept = json.loads(path.read_text(encoding="utf-8"))
                self.assertEqual(runner().differences(kept, runner().run(path)), [])

    def test_what_differs_is_found(self):
        def notebook(*texts):
            outputs = [{"output_type": "stream", "text": [text]} for text in texts]
            return {"cells": [{"cell_type": "code", "outputs": outputs}]}

        differences = runner().differences
        self.assertEqual(differences(notebook("Delta E: 1.20, of 20\n"), notebook("Delta E: 1.22, of 20\n")), [])
        self.assertEqual(len(differences(notebook("Delta E: 1.20\n"), notebook("Delta E: 1.30\n"))), 1)
        self.assertEqual(len(differences(notebook("row 5\n"), notebook("row 6\n"))), 1)
        self.assertEqual(len(differences(notebook("paint\n"), notebook("rubber\n"))), 1)
        self.assertEqual(len(differences(notebook("a\n", "b\n"), notebook("a\nb\n"))), 1)


if __name__ == "__main__":
    unittest.main()
