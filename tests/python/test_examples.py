"""The notebooks in python/examples run from start to end; what their cells end in can be shown."""

import ast
import contextlib
import io
import json
import os
import tempfile
import unittest
from pathlib import Path

import pendular

EXAMPLES = Path(__file__).parents[2] / "python" / "examples"


def run(notebook):
    """Executes the cells as Jupyter does, in one namespace; returns what each ends in."""
    names, values = {"__name__": "__main__"}, []
    for number, cell in enumerate(json.loads(notebook.read_text(encoding="utf-8"))["cells"], 1):
        if cell["cell_type"] != "code":
            continue
        tree = ast.parse("".join(cell["source"]), f"{notebook.name}, cell {number}")
        last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
        exec(compile(tree, f"{notebook.name}, cell {number}", "exec"), names)
        if last is not None:
            values.append(eval(compile(ast.Expression(last.value), f"cell {number}", "eval"), names))
    return values


class Examples(unittest.TestCase):
    def check(self, name):
        scratch = tempfile.TemporaryDirectory(prefix="pendular.")
        self.addCleanup(scratch.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(scratch.name)
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            values = run(EXAMPLES / f"{name}.ipynb")
        self.assertTrue(printed.getvalue())
        return values

    def test_scan_to_beads(self):
        picture = self.check("scan_to_beads")[-1]
        self.assertTrue(picture._repr_png_().startswith(b"\x89PNG"))

    def test_modulus_against_gap(self):
        self.assertGreater(self.check("modulus_against_gap")[-1], 1e5)

    def test_diagnosis_with_own_effect(self):
        self.addCleanup(pendular.remove_effect, "soft_below")
        values = self.check("diagnosis_with_own_effect")
        self.assertIn("<p>", values[-1]._repr_html_())


if __name__ == "__main__":
    unittest.main()
