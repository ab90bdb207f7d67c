# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of pages that come from studies: check that they are those of doc/studies/*.csv,
write or renew them.

Usage: python3 doc/scripts/study_tables.py             exit 1 if a table of a page is not what the files say
       python3 doc/scripts/study_tables.py --write     put the tables into the pages
       python3 doc/scripts/study_tables.py --run NAME...
                                               run the studies NAME.prm of prm/studies and prm/tutorial (all, if none is
                                               named) and keep study.csv here; on a quiet machine, two hours
doc/scripts/draw_plots.py draws the plots of the same files.

A page says itself which table it wants, in a comment before it; a table ends with <!-- end table -->:

<!-- table: NAME where KEY=VALUE, ...: COLUMN as HEADING; COLUMN; ... -->      a line a row of NAME.csv
<!-- orders: NAME where KEY=VALUE, ...: AXIS; AXIS, AXIS -->                   errors with observed orders, a line a value
                                                                               of the first axis
<!-- cost: NAME: AXIS -->              seconds of the cheapest run whose error is below a bound, a column a value of AXIS
<!-- extrapolation: NAME: AXIS; COLUMN; EXACT -->   a quantity as a mesh is refined, and its limit; EXACT: from elsewhere
<!-- space: NAME: NU -->             deflection over the limit and seconds of a study of errors in space, a line a mesh, a
                                    column an element
<!-- dial: NAME -->            of a study of importances: how much of its way from importance 0 to 1 the probe has gone, a line a motion
                               and an energy
<!-- elements: all -->     the stability studies, a line an element
"""
import csv
import math
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
PAGES = sorted((TOP / "doc").rglob("*.md"))
FILES, FIGURES = TOP / "doc/studies", TOP / "doc/figures"
STUDIES = {file.stem: file for folder in ("prm/studies", "prm/tutorial") for file in sorted((TOP / folder).glob("*.prm"))
           if re.search(r"^\s*set Vary", file.read_text(), re.MULTILINE)}
BOUNDS = (1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5)
COMMENT = re.compile(r"(<!-- (\w+): (\w+)(?: where ([^:]*))?(?:: (.*?))? -->\n).*?(<!-- end table -->)", re.DOTALL)


def rows_of(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def read(name):
    return rows_of(FILES / f"{name}.csv")


def chosen(name, where):
    """The rows of a file in which some keys have some values."""
    wanted = [pair.strip().split("=", 1) for pair in (where or "").split(",") if pair.strip()]
    return [row for row in read(name) if all(row[key.strip()] == value.strip() for key, value in wanted)]


def numbers(rows, column):
    return [float(row[column]) for row in rows if row[column] not in ("", "not definite")]


def short(value, digits=2):
    return f"{value:.{digits}g}" if value else "0"


def span(values):
    return f"{short(min(values))} to {short(max(values))}" if values else "–"


def most(rows, column):
    """The greatest number, 0 if none is positive, a dash if there are none."""
    return short(max([0, *numbers(rows, column)])) if numbers(rows, column) else "–"


def markdown(head, rows):
    return "\n".join("| " + " | ".join(row) + " |" for row in [head, ["---"] * len(head), *rows]) + "\n"


def axes(rows):
    """The varied keys: all columns before status, if there is one."""
    columns = list(rows[0])
    return columns[:columns.index("status")] if "status" in columns else columns


def text_of(row, column):
    """A cell: numbers that were measured or computed in three digits, settings as they are."""
    value = row[column]
    if column in axes([row]) or not re.fullmatch(r"-?[\d.]+(e[-+]?\d+)?", value):
        return re.sub(r"[\w./]*/(?=\w+\.(msh|geo))", "", value).replace("|", "\\|")
    number = float(value)
    return str(int(number)) if number == int(number) and abs(number) < 1e6 else short(number, 3)


def table(name, where, wishes):
    rows = chosen(name, where)
    columns = [re.split(r"\s+as\s+", wish.strip()) for wish in wishes.split(";")]
    return markdown([column[-1] for column in columns], [[text_of(row, column[0]) for column in columns] for row in rows])


def error(row):
    return float(row["error_position_l2"]) if row["error_position_l2"] else math.nan


def values_of(rows, keys):
    """The different values of some keys together, in order of appearance."""
    return list(dict.fromkeys(tuple(row[key] for key in keys) for row in rows))


def orders(name, where, wishes):
    rows = chosen(name, where)
    axis, others = (part.strip() for part in wishes.split(";"))
    others = [key.strip() for key in others.split(",")]
    body = {value: [value] for (value,) in values_of(rows, [axis])}
    for other in values_of(rows, others):
        before = None
        for row in (row for row in rows if tuple(row[key] for key in others) == other):
            cell = short(error(row)) if error(row) == error(row) else row["status"]
            if before and error(row) > 0 and error(before) > 0:
                order = math.log(error(before) / error(row)) / math.log(float(before[axis]) / float(row[axis]))
                cell += f" ({order:.2f})"
            body[row[axis]].append(cell)
            before = row
    return markdown([axis.split("/")[-1], *(", ".join(other) for other in values_of(rows, others))], body.values())


def cost(name, where, axis):
    axis = axis.strip()
    rows = [row for row in chosen(name, where) if error(row) == error(row)]
    methods = [value for (value,) in values_of(rows, [axis])]
    body = []
    for bound in BOUNDS:
        cheapest = {}
        for row in rows:
            method = row[axis]
            if error(row) <= bound and float(row["seconds_median"]) < cheapest.get(method, (math.inf,))[0]:
                cheapest[method] = (float(row["seconds_median"]), row)
        if not cheapest:
            continue
        best = min(seconds for seconds, row in cheapest.values())
        line = [f"{bound:g}"]
        for method in methods:
            seconds, row = cheapest.get(method, (None, None))
            how = row and ", ".join(row[key] for key in axes(rows) if key != axis)
            mark = "**" if seconds == best else ""
            line.append(f"{mark}{short(seconds)} s{mark} ({how})" if row else "–")
        body.append(line)
    return markdown(["error below", *methods], body)


def extrapolation(name, where, wishes):
    """By the observed order of the last three meshes, each twice as fine as the one before."""
    rows = chosen(name, where)
    axis, column, exact = (part.strip() for part in wishes.split(";"))
    values = [float(row[column]) for row in rows]
    ratio = (values[-1] - values[-2]) / (values[-2] - values[-3])
    limit = values[-1] + (values[-1] - values[-2]) * ratio / (1 - ratio)
    body = [[text_of(row, axis), f"{value:.5g}", f"{100 * (value / float(exact) - 1):+.2f} %"]
            for row, value in zip(rows, values)]
    body.append([f"extrapolated, order {-math.log2(ratio):.2f}", f"{limit:.5g}", f"{100 * (limit / float(exact) - 1):+.2f} %"])
    return markdown([axis.split("/")[-1], column, f"from {exact}"], body)


ELEMENTS = {("P1", "cells"): "P1", ("P1", "patches"): "P1, patches", ("P2", "cells"): "P2", ("P2", "patches"): "P2, patches"}


def space_runs(name):
    """Of a study of errors in space that went well: mesh, element, ratio of Poisson, deflection over its limit, seconds, cells of
    the mesh. A limit holds for one mesh, whose polyhedron is the body, or for all."""
    limits = {(row["body"], row["mesh"], row["nu"]): float(row["energy"]) for row in read("space_limits")}
    body = name.split("_")[1]
    for row in read(name):
        mesh = next(row[key] for key in ("Mesh/File", "Mesh/Box cells") if key in row)
        nu = row["Material/Poisson's ratio"]
        limit = limits.get((body, Path(mesh).name, nu)) or limits[body, "", nu]
        if row["status"] == "converged":
            yield (Path(mesh).name, ELEMENTS[row["Model/Element"], row["Model/Dilatation"]], nu, float(row["energy_elastic"]) / limit,
                   float(row["seconds_median"]))


def own_limit(body, mesh, element, runs):
    """Is this run the limit against which it would be held? Cat and horse take theirs from quadratic elements, on the finest mesh from
    the same ones."""
    return body in ("cat", "horse") and element == "P2, patches" and mesh == runs[-1][0]


def space(name, where, nu):
    runs = [run for run in space_runs(name) if run[2] == nu.strip()]
    body = name.split("_")[1]
    cells = {(mesh, element): ("the limit" if own_limit(body, mesh, element, runs) else f"{ratio:.3f}") + f" ({short(seconds)} s)"
             for mesh, element, _, ratio, seconds in runs}
    elements = [element for element in ELEMENTS.values() if any(run[1] == element for run in runs)]
    meshes = list(dict.fromkeys(run[0] for run in runs))
    return markdown(["mesh", *elements], [[mesh, *(cells.get((mesh, element), "–") for element in elements)] for mesh in meshes])


def dial(name, *_):
    """The way of the probe, as far as it leads where the probe is at importance 1."""
    rows, body = read(name), []
    importances = list(dict.fromkeys(float(row["Examples/Importance"]) for row in rows))
    motion = next(key for key in rows[0] if key.endswith("/Motion"))
    for drag, energy in values_of(rows, [motion, "Examples/Energy"]):
        of = [row for row in rows if (row[motion], row["Examples/Energy"]) == (drag, energy)]
        places = [[float(row[f"probe_{axis}"]) for axis in "xyz"] for row in of]
        way = [b - a for a, b in zip(places[0], places[-1])]
        gone = [sum((x - a) * w for x, a, w in zip(place, places[0], way)) / sum(w * w for w in way) for place in places]
        least = min(b - a for a, b in zip(gone, gone[1:]))
        body.append([f"`{drag}`", energy, *(f"{100 * share:.0f} %" for share in gone[1:-1]), f"{max(100 * least, 0):.1f} %"])
    return markdown(["drag", "energy", *(f"η = {eta:g}" for eta in importances[1:-1]), "least quarter"], body)


def element_of(row):
    return ELEMENTS[row["Model/Element"], row["Model/Dilatation"]]


def stability_runs():
    """The rows of each stability study."""
    return {file.stem[10:]: read(file.stem) for file in sorted(FILES.glob("stability_*.csv"))}


STABILITY = ["cases", "done", "failure reported", "wrong or crashed", "worst residual", "energy from nowhere",
             "above the bound of implicit Euler", "least det F", "condition of A"]


def summary(rows):
    """The columns STABILITY of some runs."""
    return [str(len(rows)), *(str(sum(row["exit_status"] == status for row in rows)) for status in "02"),
            str(sum(row["exit_status"] not in "02" for row in rows)),
            short(max(numbers(rows, "residual"))), most(rows, "energy_growth"), most(rows, "bound_excess"),
            short(min(numbers(rows, "min_det_F"))), span(numbers(rows, "condition_matrix"))]


def elements(*_):
    runs = stability_runs()
    body = []
    for element in ELEMENTS.values():
        rows = [row for study in runs.values() for row in study if element_of(row) == element]
        body.append([element, *summary(rows)])
    return markdown(["element", *STABILITY], body)


KINDS = {make.__name__: make
         for make in (table, orders, cost, extrapolation, dial, space, elements)}


def page_with_tables(page):
    return COMMENT.sub(lambda found: found[1] + KINDS[found[2]](found[3], found[4], found[5]) + found[6], page)


def run(name):
    """Its study.csv, in output/studies, where a study that was stopped goes on."""
    program = os.environ.get("EXEMPLAR", str(TOP / "build/release/exemplar"))
    output = TOP / "output/studies" / name
    subprocess.run([program, "study", str(STUDIES[name]), "--quiet", "--output", str(output)], check=True)
    return output / "study.csv"


def results(name):
    return rows_of(run(name))


def main():
    if sys.argv[1:2] == ["--run"]:
        for name in sys.argv[2:] or STUDIES:
            print(name, file=sys.stderr, flush=True)
            shutil.copy(run(name), FILES / f"{name}.csv")
        return
    missing = [name for name in STUDIES if not (FILES / f"{name}.csv").exists()]
    if missing:
        sys.exit(f"doc/studies has no results of {', '.join(missing)}: python3 doc/scripts/study_tables.py --run NAME")
    for page in PAGES:
        right = page_with_tables(page.read_text())
        if sys.argv[1:] == ["--write"]:
            page.write_text(right)
        elif page.read_text() != right:
            sys.exit(f"{page} has other numbers than doc/studies/*.csv: python3 doc/scripts/study_tables.py --write")
    print("the pages have the numbers of doc/studies")


if __name__ == "__main__":
    main()
