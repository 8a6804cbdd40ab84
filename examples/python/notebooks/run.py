"""Runs notebooks without Jupyter: `run.py NOTEBOOK...` executes their code cells and compares the outputs with the
stored ones; `run.py --write NOTEBOOK...` stores the new outputs, with the figures. Needs matplotlib.

Numbers in text may differ by 3 in their last digit: processors round differently.
"""

import base64
import contextlib
import io
import json
import os
import pathlib
import re
import sys

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt  # noqa: E402

NUMBER = re.compile(r"-?\d+(?:\.\d+)?")


def png_of(figure):
    """Returns a figure as a notebook stores it: a PNG in base64, the same bytes each time."""
    file = io.BytesIO()
    figure.savefig(file, format="png", dpi=80, bbox_inches="tight", metadata={"Software": None})
    return base64.b64encode(file.getvalue()).decode()


def outputs_of(cell, names, label):
    """Executes a cell. Returns its text and figures as a notebook stores them, in the order of output."""
    outputs, printed = [], io.StringIO()

    def flush():
        if text := printed.getvalue():
            outputs.append({"name": "stdout", "output_type": "stream", "text": text.splitlines(keepends=True)})
        printed.seek(0)
        printed.truncate()

    def show(*_, **__):
        flush()
        for number in plt.get_fignums():
            outputs.append({"data": {"image/png": png_of(plt.figure(number))}, "metadata": {}, "output_type": "display_data"})
        plt.close("all")

    plt.show = show
    with contextlib.redirect_stdout(printed):
        exec(compile("".join(cell["source"]), label, "exec"), names)
    flush()
    return outputs


def run(path):
    """Returns the notebook with new outputs of its cells. Cells run in the notebook's folder, as in Jupyter."""
    path = pathlib.Path(path).resolve()
    notebook = json.loads(path.read_text(encoding="utf-8"))
    names, before = {"__name__": "__main__"}, os.getcwd()
    os.chdir(path.parent)
    try:
        code = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
        for number, cell in enumerate(code, start=1):
            cell["outputs"] = outputs_of(cell, names, f"{path.name}, cell {number}")
            cell["execution_count"] = number
    finally:
        os.chdir(before)
        plt.close("all")
    return notebook


def is_same_text(kept, now):
    """Returns whether two texts differ only in the last digits of decimal numbers."""
    if NUMBER.sub("#", kept) != NUMBER.sub("#", now):
        return False
    for a, b in zip(NUMBER.findall(kept), NUMBER.findall(now)):
        digits = len(b.partition(".")[2])
        if a != b and (digits == 0 or round(abs(float(a) - float(b)) * 10**digits) > 3):
            return False
    return True


def differences(kept, now):
    """Returns a sentence for each cell whose outputs differ from the stored ones in text, or in the number of figures."""
    found = []
    for number, (a, b) in enumerate(zip(kept["cells"], now["cells"]), start=1):
        kinds = [[each["output_type"] for each in cell.get("outputs", [])] for cell in (a, b)]
        texts = ["".join("".join(each.get("text", [])) for each in cell.get("outputs", [])) for cell in (a, b)]
        if kinds[0] != kinds[1] or not is_same_text(*texts):
            found.append(f"cell {number}: kept {kinds[0]} {texts[0]!r}, now {kinds[1]} {texts[1]!r}")
    return found


def main(arguments):
    writes = arguments[:1] == ["--write"]
    failed = False
    for path in map(pathlib.Path, arguments[1 if writes else 0:]):
        now = run(path)
        if writes:
            path.write_text(json.dumps(now, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
            continue
        for sentence in differences(json.loads(path.read_text(encoding="utf-8")), now):
            failed = True
            print(f"{path}, {sentence}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
