# SPDX-License-Identifier: GPL-3.0-or-later
"""Make the documentation site from the pages of the project by Debian's mkdocs-material, mkdocs, python3-pymdownx and
libjs-katex, for a web server or for reading from the disk: it fetches nothing from elsewhere. The reference of the names is in
it where build_reference.py can make it.

Usage: /usr/bin/python3 packaging/build_site.py DIRECTORY      pages in DIRECTORY/site, begin with index.html; exit 77 if
                                                               a package is missing
"""
import importlib.util
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import build_reference

TOP = Path(__file__).resolve().parents[1]
KATEX = Path("/usr/share/javascript/katex")
THEMES = Path("/usr/share/mkdocs/themes")

# Beside the pages, what they link to
FOLDERS = ["doc", "prm", "meshes", "tests/embed", "tests/benchmark/scenes", "tests/scenes", "tests/live"]
FILES = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "CITATION.cff", "LICENSE"]

# The elements in which arithmatex left the formulas, set by KaTeX
FORMULAS = r"""
for (const element of document.querySelectorAll(".arithmatex")) {
  const display = element.tagName == "DIV";
  katex.render(element.textContent.trim().slice(2, -2), element, { displayMode: display, throwOnError: false });
}
"""

# The theme makes displayed formulas as narrow as they can be, and their numbers stand upon them
STYLE = """
.md-typeset div.arithmatex > * { width: auto; }
.md-grid { max-width: 76rem; }
"""


def copy_pages(pages):
    for folder in FOLDERS:
        shutil.copytree(TOP / folder, pages / folder, ignore=shutil.ignore_patterns("__pycache__"))
    for file in FILES:
        shutil.copy(TOP / file, pages / file)
    shutil.copytree(KATEX, pages / "katex", symlinks=False)
    Path(pages, "katex/formulas.js").write_text(FORMULAS)
    Path(pages, "site.css").write_text(STYLE)


def list_folder(folder):
    """A page for a folder without one, as browsers of the repository show it."""
    files = sorted(file.relative_to(folder) for file in folder.rglob("*") if file.is_file())
    rows = "\n".join(f"- [{file}]({file})" for file in files)
    Path(folder, "README.md").write_text(f"# {folder.name}\n\n{rows}\n")


def lead_to_pages(page):
    """A link to a folder leads to its page."""

    def lead(link):
        path, anchor = link[1], link[2] or ""
        folder = page.parent / path
        if re.match(r"[a-z]+:", path) or not folder.is_dir():
            return link[0]
        if not (folder / "README.md").exists():
            list_folder(folder)
        return f"]({path.rstrip('/')}/README.md{anchor})"

    page.write_text(re.sub(r"\]\(([^)\s#]+)(#[^)\s]*)?\)", lead, page.read_text()))


def require_packages():
    sys.path.append(str(THEMES))
    missing = [module for module in ("mkdocs", "material", "pymdownx") if not importlib.util.find_spec(module)]
    if missing or not KATEX.is_dir():
        print("The site is not built. It needs Debian's mkdocs-material, mkdocs, python3-pymdownx and libjs-katex.")
        sys.exit(77)


def write_menu(site, with_reference):
    menu = (TOP / "packaging/mkdocs.yml").read_text()
    lines = [line for line in menu.splitlines() if with_reference or "reference/README.md" not in line]
    Path(site, "mkdocs.yml").write_text("\n".join(lines) + "\n")


def main():
    require_packages()
    site = Path(sys.argv[1]).resolve()
    shutil.rmtree(site, ignore_errors=True)
    pages = site / "pages"
    pages.mkdir(parents=True)
    copy_pages(pages)
    for page in list(pages.rglob("*.md")):
        lead_to_pages(page)
    with_reference = build_reference.can_build()
    if with_reference:
        build_reference.build(pages / "reference")
    write_menu(site, with_reference)
    done = subprocess.run([sys.executable, "-m", "mkdocs", "build", "--strict", "--config-file", site / "mkdocs.yml"],
                          env={**os.environ, "PYTHONPATH": str(THEMES)})
    shutil.rmtree(pages)
    sys.exit(done.returncode)


main()
