# SPDX-License-Identifier: GPL-3.0-or-later
"""Write the reference: README.md of the Python module, from its docstrings, and cpp/ of the C++ headers that programs of others
use, by Doxygen. These are exemplar/exemplar.h if it is there and run/problem.h with what they include, and the headers of what
doc/embedding.md names.

Usage: PYTHONPATH=build/release/python python3 packaging/build_reference.py DIRECTORY
Fails with the public functions that have no `///`; exit 77 without Doxygen or the module.
"""
import ast
import inspect
import re
import shutil
import subprocess
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[1]
INCLUDE = TOP / "include"
DOORS = ["exemplar/exemplar.h", "exemplar/run/problem.h"]
HEAD = """# Reference

What `help()` says of the Python module, name by name; [python.md](../doc/python.md) begins from the beginning. The types of C++
that programs of others use: [C++](cpp/index.html), with [embedding.md](../doc/embedding.md) before it. n counts nodes and m cells.
"""
DOXYFILE = """PROJECT_NAME = exemplar
PROJECT_BRIEF = "Elastic solids that deform the way their examples say"
OUTPUT_DIRECTORY = {directory}
HTML_OUTPUT = cpp
GENERATE_LATEX = NO
STRIP_FROM_PATH = {include}
STRIP_FROM_INC_PATH = {include}
JAVADOC_AUTOBRIEF = YES
HIDE_UNDOC_RELATIONS = YES
SORT_MEMBER_DOCS = NO
VERBATIM_HEADERS = NO
HTML_TIMESTAMP = NO
MARKDOWN_SUPPORT = NO
MACRO_EXPANSION = NO
QUIET = YES
WARN_LOGFILE = {log}
INPUT = {headers}
"""


def public(members):
    return {name: member for name, member in members.items() if not name.startswith("_") and not inspect.ismodule(member)}


def escaped(text):
    """Text for Markdown: only what is in backticks stands for itself."""
    parts = text.split("`")
    return "`".join(part if i % 2 else re.sub(r"([\\*_<\[\]])", r"\\\1", part) for i, part in enumerate(parts))


def entry(name, member, level):
    """A heading with the call, and what the docstring says below it."""
    doc = inspect.getdoc(member) or ""
    call = re.match(r"\w+(\(.*?\)(?:\s+-> [^\n]+)?)(\n\n|$)", doc, re.DOTALL)
    if call:
        doc = doc[call.end():]
    heading = name + re.sub(r"\s+", " ", call[1]) if call else name
    return f"{'#' * level} `{heading}`\n\n{marked(doc)}\n"


def marked(doc):
    """A docstring in Markdown, with the example in which it ends."""
    text, begins, example = doc.partition(">>> ")
    return escaped(text) + (f"```python\n{begins}{example}\n```" if begins else "")


def python_page():
    import exemplar
    parts = [HEAD]
    for name, member in public(vars(exemplar)).items():
        parts.append(entry(name, member, 2))
        if not isinstance(member, type):
            continue
        init = inspect.getdoc(member.__init__) or ""
        if init.startswith(f"{name}("):
            parts.append(entry(name, member.__init__, 3))
        parts += [entry(f"{name}.{inner}", value, 3) for inner, value in public(vars(member)).items()]
    return "\n".join([*parts, *wrappers()])


def wrappers():
    """Of the files for torch and jax, which need not be here, what their functions say."""
    for file in sorted((TOP / "source/python").glob("with_*.py")):
        for function in ast.parse(file.read_text()).body:
            if isinstance(function, ast.FunctionDef) and not function.name.startswith("_"):
                call = f"exemplar.{file.stem}.{function.name}({ast.unparse(function.args)})"
                yield f"## `{call}`\n\n{marked(ast.get_docstring(function))}\n"


def included_by(header):
    return re.findall(r"#include <(exemplar/[\w/]+\.h)>", (INCLUDE / header).read_text())


def public_headers():
    doors = [door for door in DOORS if (INCLUDE / door).exists()]
    found = {*doors, *(header for door in doors for header in included_by(door))}
    page = (TOP / "doc/embedding.md").read_text()
    names = set(re.findall(r"`(?:\w+::)?(\w+)(?:\(\))?`", page))
    for file in (INCLUDE / "exemplar").rglob("*.h"):
        if file.parent.name == "kernels":
            continue  # no program of others sees these
        defined = re.findall(r"^  (?:class|struct) (\w+)[^;]*$|^  (\w+)\([^;]*;", file.read_text(), re.MULTILINE)
        if names & {name for pair in defined for name in pair}:
            found.add(str(file.relative_to(INCLUDE)))
    return sorted(found)


def build_cpp(directory):
    """The pages of the headers; what Doxygen says of functions without a word of explanation."""
    log = directory / "doxygen.log"
    headers = " ".join(f'"{INCLUDE / header}"' for header in public_headers())
    doxyfile = directory / "Doxyfile"
    doxyfile.write_text(DOXYFILE.format(directory=directory, include=INCLUDE, headers=headers, log=log))
    subprocess.run(["doxygen", doxyfile], check=True, stdout=subprocess.DEVNULL)
    found = [line for line in log.read_text().splitlines() if re.search(r"Member .*\(function\).* is not documented", line)]
    doxyfile.unlink()
    log.unlink()
    return [line.replace(f"{INCLUDE}/", "") for line in found]


def can_build():
    try:
        import exemplar  # noqa: F401
    except ImportError:
        return False
    return shutil.which("doxygen") is not None


def build(directory):
    directory.mkdir(parents=True, exist_ok=True)
    (directory / "README.md").write_text(python_page())
    return build_cpp(directory)


def main():
    if not can_build():
        print("The reference is not built. It needs Debian's doxygen, and the Python module in PYTHONPATH.")
        sys.exit(77)
    directory = Path(sys.argv[1]).resolve()
    shutil.rmtree(directory, ignore_errors=True)
    faults = build(directory)
    print("\n".join(faults) or f"{len(public_headers())} headers, begin with {directory}/cpp/index.html and {directory}/README.md")
    sys.exit(bool(faults))


if __name__ == "__main__":
    main()
