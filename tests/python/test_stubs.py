"""The stubs of the compiled parts say what is in them."""

import ast
import importlib
import unittest
from pathlib import Path

import pendular


def named_in(stub):
    tree = ast.parse(stub.read_text())
    found = {}
    for node in tree.body:
        if isinstance(node, ast.ClassDef):
            found[node.name] = {part.name for part in node.body if isinstance(part, ast.FunctionDef)} | {
                part.target.id for part in node.body if isinstance(part, ast.AnnAssign)}
        elif isinstance(node, ast.FunctionDef):
            found[node.name] = set()
        elif isinstance(node, ast.AnnAssign):
            found[node.target.id] = set()
    return found


class Stubs(unittest.TestCase):
    def test_names_agree(self):
        for name in ("_core", "_pictures"):
            module = importlib.import_module(f"pendular.{name}")
            told = named_in(Path(pendular.__file__).with_name(f"{name}.pyi"))
            there = {key for key in vars(module) if not key.startswith("__")}
            self.assertEqual(set(told), there, name)
            for key, members in told.items():
                if isinstance(getattr(module, key), type):
                    shown = {member for member in vars(getattr(module, key)) if not member.startswith("_")}
                    self.assertEqual({member for member in members if not member.startswith("_")}, shown, f"{name}.{key}")

    def test_package_is_marked_as_typed(self):
        self.assertTrue(Path(pendular.__file__).with_name("py.typed").exists())


if __name__ == "__main__":
    unittest.main()
