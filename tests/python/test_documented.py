"""docs/learn/python.md shows what its programs print."""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

from surroundings import DATA, SOURCE

PAGE = SOURCE / "docs" / "learn" / "python.md"


class DocumentedProgramsTest(unittest.TestCase):
    def run_in_copy(self, program):
        """What a program prints in a folder with the project's data, and the names of the files that it leaves."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            for file in ("materials.prior", "measurements.csv"):
                shutil.copy(DATA / file, folder)
            done = subprocess.run([sys.executable, SOURCE / program], cwd=folder, check=True, stdout=subprocess.PIPE,
                                  text=True)
            return done.stdout, {path.name for path in folder.iterdir()}

    def test_outputs(self):
        shown = re.findall(r"<!-- output of (\S+) -->\n```\n(.*?)```", PAGE.read_text(), re.DOTALL)
        self.assertEqual([program for program, _ in shown], ["examples/python/how_sure.py"])
        for program, output in shown:
            self.assertEqual(self.run_in_copy(program)[0], output)

    def test_first_program_in_five_lines(self):
        program = "examples/python/first_program.py"
        self.assertEqual(len((SOURCE / program).read_text().splitlines()), 5)
        self.assertIn("paint.binary", self.run_in_copy(program)[1])


if __name__ == "__main__":
    unittest.main()
