# SPDX-License-Identifier: GPL-3.0-or-later
"""Every relative link of the pages leads to a file that is there and, with an #anchor, to a heading of it; and every page is
reached from README.md, those of doc/ are in the site's menu. Lists what is not so.

Usage: python3 tests/checks/links.py
"""
import re
import sys
from pathlib import Path
from urllib.parse import unquote

TOP = Path(__file__).resolve().parents[2]


def without_code(text):
    text = re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE)
    return re.sub(r"`[^`\n]*`", "", text)


def links(page):
    """Targets of links and pictures, without those elsewhere in the world."""
    targets = re.findall(r"\]\(([^)\s]+)[^)]*\)", without_code(page.read_text()))
    return [unquote(target) for target in targets if not re.match(r"[a-z]+:", target)]


def anchors(page):
    """The names of a page's headings as GitHub makes them: two of the same name are a and a-1."""
    found = []
    for heading in re.findall(r"^#+ +(.*?) *$", re.sub(r"^```.*?^```", "", page.read_text(), flags=re.DOTALL | re.MULTILINE),
                              flags=re.MULTILINE):
        words = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading).lower()
        name = re.sub(r"[^\w\- ]", "", words).replace(" ", "-")
        repeated = sum(1 for other in found if re.fullmatch(re.escape(name) + r"(-\d+)?", other))
        found.append(f"{name}-{repeated}" if repeated else name)
    return found


def check_link(page, target):
    """What is wrong with a link, or nothing; and the page that it leads to, if it is one."""
    path, _, anchor = target.partition("#")
    file = (page.parent / path).resolve() if path else page
    if not file.is_relative_to(TOP) or not file.exists():
        return "there is no such file", None
    if file.is_dir():
        file /= "README.md"
    if file.suffix != ".md" or not file.exists():
        return "an anchor in what is no page" if anchor else None, None
    return f"there is no heading #{anchor}" if anchor and anchor not in anchors(file) else None, file


def pages():
    return [page for folder in ("doc", "meshes", "prm") for page in (TOP / folder).rglob("*.md")] + list(TOP.glob("*.md"))


def main():
    leads_to, faults, n_links = {}, [], 0
    for page in sorted(pages()):
        leads_to[page] = set()
        for target in links(page):
            fault, file = check_link(page, target)
            n_links += 1
            leads_to[page].add(file)
            if fault:
                faults.append(f"{page.relative_to(TOP)}: ({target}): {fault}")
    reached, new = set(), {TOP / "README.md"}
    while new:
        reached |= new
        new = {file for page in new for file in leads_to.get(page, ()) if file} - reached
    faults += [f"{page.relative_to(TOP)} is reached from no page" for page in sorted(leads_to) if page not in reached]
    site = (TOP / "packaging/mkdocs.yml").read_text()
    faults += [f"{page.relative_to(TOP)} is not in packaging/mkdocs.yml" for page in sorted(leads_to)
               if page.is_relative_to(TOP / "doc") and f": {page.relative_to(TOP)}\n" not in site]
    print("\n".join(faults) or f"{n_links} links on {len(leads_to)} pages")
    sys.exit(bool(faults))


main()
