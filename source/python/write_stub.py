# SPDX-License-Identifier: GPL-3.0-or-later
"""Write the types of the module `exemplar` for mypy and editors, as the module itself says them: each public name with its
docstring. The build calls this after the module is linked.

Usage: PYTHONPATH=build/release/python python3 source/python/write_stub.py FILE

A method's docstring begins with its call, "name(a, b=None) -> type". What docstrings do not say is in
ARGUMENTS and PROPERTIES; what is not there either is Any. An argument whose default is None may be None.
"""
import ast
import inspect
import re
import sys
import types

import exemplar

# packages that may be absent, or have no types, stand there for Any
HEAD = '''# Written by source/python/write_stub.py.
# mypy: disable-error-code="import"
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, SupportsFloat

import matplotlib.animation
import mpl_toolkits.mplot3d.axes3d
import numpy as np
import scipy.sparse
import scipy.sparse.linalg
from numpy.typing import ArrayLike, NDArray

from exemplar._live import Live
'''
TERM = "Callable[[NDArray[np.float64], float], tuple[SupportsFloat, ArrayLike, object]]"

# Types of arguments, by "name" or "function.name"
ARGUMENTS = {
    "scene": "str | os.PathLike[str] | Mapping[str, Any]", "mesh": "Sequence[ArrayLike]", "poses": "Sequence[ArrayLike]",
    "name": "str", "kind": "str", "dt": "float", "time": "float", "i": "int", "step": "int", "port": "int", "record": "str | os.PathLike[str]",
    "nodes": "ArrayLike", "positions": "ArrayLike", "velocities": "ArrayLike", "weights": "ArrayLike", "values": "ArrayLike",
    "young": "ArrayLike", "poisson": "ArrayLike", "density": "ArrayLike", "region": "str | int | ArrayLike | Mapping[str, float] | None", "value": "float | None",
    "dJ_dx": "ArrayLike | Sequence[ArrayLike | None] | None",
    "dJ_dw": "ArrayLike | Sequence[ArrayLike | None] | None", "dJ_dv": "Sequence[ArrayLike | None] | None",
    "set_motion.function": "Callable[[NDArray[np.float64], float], ArrayLike]",
    "grab.function": "Callable[[NDArray[np.float64], float], ArrayLike]",
    "add_obstacle.shape": "str | tuple[ArrayLike, ArrayLike]", "motion": "str", "turn": "str", "friction": "float",
    "add_term.function": TERM, "check_term.term": f"int | {TERM}",
    "animate.positions": "Iterable[ArrayLike]", "interval": "float", "file": "str | os.PathLike[str]",
    "on_iteration.function": "Callable[[Report], object] | None",
}

# methods for a with statement and len(), of the types that have them
SPECIAL = {"__enter__": "def __enter__(self) -> {name}: ...", "__exit__": "def __exit__(self, *args: Any) -> None: ...",
           "__len__": "def __len__(self) -> int: ..."}

# types of properties that can be set; a checker that knows but one type of a property takes that of
# the value it has
SETTERS = {
    "state": "State", "gravity": "ArrayLike", "nodal_forces": "ArrayLike | None", "importance": "float", "mass_damping": "float",
    "stiffness_damping": "float",
}

PROPERTIES = {
    "mass": "scipy.sparse.csr_array", "handles": "dict[str, NDArray[np.uint32]]", "example_names": "list[str]", "friction_settled": "bool",
    "obstacles": "dict[str, dict[str, Any]]", "weight_regions": "list[dict[str, Any]]",
    "weights": "NDArray[np.float64]", "history": "NDArray[np.float64]", "gravity": "NDArray[np.float64]",
    "times": "list[float]", "energies": "Measures", "statistics": "Measures", "warnings": "list[str]", "residual_history": "list[float]", "status": "str",
    "iterations": "int", "factorizations": "int", "step_number": "int", "n_steps": "int", "step": "int", "time": "float",
    "residual": "float", "kkt_residual": "float", "step_length": "float", "newton_decrement": "float",
    "importance": "float", "mass_damping": "float", "stiffness_damping": "float",
}


def public(members):
    return {name: member for name, member in members.items() if not name.startswith("_")}


def indented(text, by="    "):
    return "\n".join(by + line if line else "" for line in text.splitlines())


def body_of(doc, by="    "):
    """A docstring as the body of what it explains, or dots."""
    return indented(f'r"""{doc}"""' if "\n" not in doc else f'r"""{doc}\n"""', by) if doc else by + "..."


def call_of(doc):
    """(arguments, type) of the call that a docstring begins with, or None."""
    found = re.match(r"\w+\(([^()]*(?:\([^()]*\)[^()]*)*)\)(?:\s+-> ([^\n]+))?\n\n", doc + "\n\n")
    return found and (found[1].replace("\n", " "), (found[2] or "None").replace("exemplar.", ""))


def type_of_result(name):
    """The type by which a call's docstring names its result, such as "float", "Report", or the shape (n, 3) of an array."""
    name = re.sub(r" \([\w, ]+\)$", "", name)  # without the shape
    if re.fullmatch(r"\([\w, ]+\)", name):
        return "NDArray[np.float64]"
    is_known = re.fullmatch(r"None|int|float|bool|str|Live|(dict|list)\[.*\]|(scipy|matplotlib|mpl_toolkits)\.[\w.]+", name) or hasattr(exemplar, name)
    return name if is_known else "Any"


def typed(function, arguments):
    """The arguments with their types."""
    parsed = ast.parse(f"def f({arguments}): pass").body[0].args
    given = [*parsed.posonlyargs, *parsed.args]
    defaults = [None] * (len(given) - len(parsed.defaults)) + parsed.defaults + parsed.kw_defaults
    for argument, default in zip([*given, *parsed.kwonlyargs], defaults):
        if argument.arg != "self":
            name = ARGUMENTS.get(f"{function}.{argument.arg}", ARGUMENTS.get(argument.arg, "Any"))
            may_be_none = isinstance(default, ast.Constant) and default.value is None and "None" not in name and name != "Any"
            argument.annotation = ast.parse(name + " | None" * may_be_none, mode="eval").body
    return ast.unparse(parsed)


def function_lines(name, doc, self=""):
    arguments, result = call_of(doc) or ("*args, **kwargs", "Any")
    given = typed(name, ", ".join(filter(None, [self, re.sub(r"^self[^,]*,? *", "", arguments)])))
    return f"def {name}({given}) -> {type_of_result(result)}:\n{body_of(doc)}"


def type_of_property(name, doc):
    if doc.startswith("A list with"):
        return "list[NDArray[np.float64]]"
    if name in PROPERTIES:
        return PROPERTIES[name]
    number = "np.uint32" if "uint32" in doc else "np.float64"
    if "scipy.sparse" not in doc and re.search(r"\((examples, )?[nmk],[ \d,]*\)", doc):
        return f"NDArray[{number}]" + (" | None" if "None unless" in doc else "")
    shown = re.search(r"\ban? exemplar\.(\w+)", doc)
    if shown and hasattr(exemplar, shown[1]):
        return shown[1]
    return "Any"


def property_lines(name, member):
    doc = inspect.getdoc(member) or ""
    lines = f"@property\ndef {name}(self) -> {type_of_property(name, doc)}:\n{body_of(doc)}"
    if name in SETTERS and getattr(member, "fset", None):
        lines += f"\n@{name}.setter\ndef {name}(self, value: {SETTERS[name]}) -> None: ..."
    return lines


def class_lines(name, kind):
    bases = "dict[str, float]" if name == "Measures" else ", ".join(base.__name__ for base in kind.__bases__)
    doc = kind.__doc__ or ""
    found = [body_of(doc)]
    init = inspect.getdoc(kind.__init__) or ""
    if init.startswith(f"{name}("):
        found.append(indented(function_lines("__init__", init, "self").replace(" -> Any", " -> None")))
    for member, value in public(vars(kind)).items():
        is_method = callable(value) and not isinstance(value, (property, type))
        lines = function_lines(member, value.__doc__ or "", "self") if is_method else property_lines(member, value)
        found.append(indented(lines))
    found += [indented(line.format(name=name)) for special, line in SPECIAL.items() if special in vars(kind)]
    return f"class {name}({bases}):\n" + "\n\n".join(found)


def stub():
    parts = [HEAD, "__version__: str"]
    for name, member in public(vars(exemplar)).items():
        if isinstance(member, types.ModuleType):
            continue
        parts.append(class_lines(name, member).replace("(pybind11_object)", "").replace("(object)", "")
                     if isinstance(member, type) else function_lines(name, member.__doc__ or ""))
    return "\n\n".join(parts) + "\n"


if __name__ == "__main__":
    with open(sys.argv[1], "w", encoding="utf-8") as file:
        file.write(stub())
