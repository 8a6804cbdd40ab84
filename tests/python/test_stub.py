"""The stub file says of each name what the compiled module says: parameters, their order and defaults."""

import ast
import inspect
import pathlib
import re
import unittest

import gonio

STUB = pathlib.Path(gonio.__file__).with_name("__init__.pyi")


def signature_of(node):
    """Names and defaults of a function of the stub, without self; None in the place of the star."""
    arguments = node.args
    positional = arguments.posonlyargs + arguments.args
    defaults = [None] * (len(positional) - len(arguments.defaults)) + arguments.defaults
    found = [(a.arg, d and ast.unparse(d)) for a, d in zip(positional, defaults) if a.arg != "self"]
    if arguments.kwonlyargs:
        found.append(("*", None))
        found += [(a.arg, d and ast.unparse(d)) for a, d in zip(arguments.kwonlyargs, arguments.kw_defaults)]
    return tuple(found)


def signatures_of(function):
    """The same from the first lines that pybind11 writes into a docstring; one for each overload."""
    name = function.__name__
    lines = re.findall(rf"^(?:\d+\. )?{re.escape(name)}\((.*)\) -> ", function.__doc__, re.MULTILINE)
    found = set()
    for line in lines:
        # Types may be anything between a colon and the next default or comma: they are not compared.
        parts = [p.strip() for p in re.split(r",(?![^\[<(]*[\]>)])", line) if p.strip()]
        signature = []
        for part in parts:
            match = re.fullmatch(r"(\*|\w+)(?:: (.*?))?(?: = (.*))?", part)
            if match.group(1) != "self":
                signature.append((match.group(1), match.group(3)))
        found.add(tuple(signature))
    return found


class StubTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        tree = ast.parse(STUB.read_text())
        cls.functions, cls.classes = {}, {}
        for node in tree.body:
            if isinstance(node, ast.FunctionDef):
                cls.functions.setdefault(node.name, []).append(node)
            elif isinstance(node, ast.ClassDef):
                cls.classes[node.name] = node

    def members_of(self, name):
        """Functions of a class and of what it is made of, by name."""
        node, found = self.classes[name], {}
        for base in node.bases:
            if isinstance(base, ast.Name) and base.id in self.classes:
                found.update(self.members_of(base.id))
        for each in node.body:
            if isinstance(each, ast.FunctionDef):
                found.setdefault(each.name, []).append(each)
        return found

    def same(self, name, function, nodes):
        self.assertEqual(signatures_of(function), {signature_of(node) for node in nodes}, name)

    def test_names(self):
        declared = set(self.functions) | {name for name in self.classes if not name.startswith("_")}
        self.assertEqual(declared, set(gonio.__all__))

    def test_functions(self):
        for name, nodes in self.functions.items():
            self.same(name, getattr(gonio, name), nodes)

    def test_members(self):
        for name in self.classes:
            if name.startswith("_") or name == "Error":
                continue
            # pybind11's own, from 2.12 on: _pybind11_conduit_v1_.
            of_others = ("__", "_pybind11_")
            actual = {n: m for n, m in vars(getattr(gonio, name)).items() if not n.startswith(of_others)}
            actual.update({n: m for n, m in vars(getattr(gonio, name)).items() if n in ("__call__", "__len__", "__getitem__", "__iter__", "__array__")})
            declared = self.members_of(name)
            self.assertEqual(set(declared) - {"__init__"}, set(actual), name)
            for member, value in actual.items():
                is_property = any(isinstance(d, ast.Name) and d.id == "property" for d in declared[member][0].decorator_list)
                self.assertEqual(is_property, isinstance(value, property), f"{name}.{member}")
                if not is_property and member == "fit" and len(signatures_of(value)) > 1:
                    self.fail(f"{name}.{member} has overloads of other parameters")
                if not is_property:
                    self.same(f"{name}.{member}", value, declared[member])
            if "__init__" in declared:
                self.same(f"{name}.__init__", getattr(gonio, name).__init__, declared["__init__"])

    def test_everything_is_documented(self):
        for name in gonio.__all__:
            text = inspect.getdoc(getattr(gonio, name)) or ""
            sentences = [line for line in text.splitlines() if not re.match(r"^(\d+\. )?\w+\(", line)]
            if name != "formula_material_names":
                self.assertTrue("".join(sentences).strip(), name)


if __name__ == "__main__":
    unittest.main()
