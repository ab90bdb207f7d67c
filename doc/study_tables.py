# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of doc/results.md that come from studies: check that they are those of doc/studies/*.csv, write or renew them.

Usage: python3 doc/study_tables.py             exit 1 if a table of the page is not what the files say
       python3 doc/study_tables.py --write     put the tables into the page
       python3 doc/study_tables.py --run NAME...
                                               run prm/studies/NAME.prm (all, if none is named), keep study.csv and
                                               study.svg here; on a quiet machine, half an hour
"""
import csv
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

TOP = Path(__file__).resolve().parents[1]
PAGE, FILES, FIGURES = TOP / "doc/results.md", TOP / "doc/studies", TOP / "doc/figures"
STUDIES = TOP / "prm/studies"


def read(name):
    with open(FILES / f"{name}.csv", newline="") as file:
        return list(csv.DictReader(file))


def numbers(rows, column):
    return [float(row[column]) for row in rows if row[column] not in ("", "not definite")]


def short(value):
    return f"{value:.2g}" if value else "0"


def span(values):
    return f"{short(min(values))} to {short(max(values))}" if values else "–"


def table(head, rows):
    return "\n".join("| " + " | ".join(row) + " |" for row in [head, ["---"] * len(head), *rows])


def axes(rows):
    """The varied keys: all columns before status."""
    columns = list(rows[0])
    return columns[:columns.index("status")]


def stability():
    body = []
    for file in sorted(FILES.glob("stability_*.csv")):
        rows = read(file.stem)
        converged = [row for row in rows if row["exit_status"] == "0"]
        schur = span(numbers(rows, "condition_schur"))
        if any(row["condition_schur"] == "not definite" for row in rows):
            schur += ", not definite"
        body.append([f"[{file.stem[10:]}](../prm/studies/{file.stem}.prm)", str(len(rows)), str(len(converged)),
                     str(sum(row["exit_status"] == "2" for row in rows)),
                     str(sum(row["exit_status"] not in "02" for row in rows)),
                     short(max(numbers(rows, "residual"))), short(max([0, *numbers(rows, "energy_growth")])),
                     short(min(numbers(rows, "min_det_F"))), span(numbers(rows, "condition_matrix")), schur,
                     short(max([0, *numbers(rows, "kkt_residual")]))])
    total = ["all", *(str(sum(int(row[i]) for row in body)) for i in range(1, 5)), *[""] * 6]
    return table(["study", "cases", "done", "failure reported", "wrong or crashed", "worst residual",
                  "energy from nowhere", "least det F", "condition of A", "of the Schur complement", "worst KKT residual"],
                 body + [total])


def failures():
    body = []
    for file in sorted(FILES.glob("stability_*.csv")):
        rows = read(file.stem)
        for row in rows:
            if row["exit_status"] != "0":
                values = ", ".join(f"{key.split('/')[-1]} = `{row[key]}`" for key in axes(rows))
                body.append([file.stem[10:], values.replace("|", "\\|"), row["status"], row["steps"] or "0"])
    return table(["study", "case", "how it ended", "steps before"], body)


def error(row):
    return short(float(row["error_position_l2"])) if row["error_position_l2"] else row["status"]


def errors(name):
    rows = read(name)
    keys = axes(rows)
    has_errors = any(row["error_position_l2"] for row in rows)
    body = [[*(row[key].replace("../../meshes/poses/", "") for key in keys), *([error(row)] if has_errors else []),
             short(float(row["seconds_median"])), row["iterations"]] for row in rows]
    return table([*(key.split("/")[-1] for key in keys), *(["error of positions (L2)"] if has_errors else []), "seconds",
                  "iterations"], body)


TABLES = {"stability": stability, "failures": failures,
          **{name: lambda name=name: errors(name) for name in (
              "time_step_bar", "time_step_cat", "time_scheme", "gradient", "strain", "solver_tolerance", "examples_count",
              "damping")}}


def page_with_tables(page):
    for name, make in TABLES.items():
        begin, end = f"<!-- {name}: begin -->\n", f"<!-- {name}: end -->"
        if begin in page:
            before, rest = page.split(begin, 1)
            page = before + begin + make() + "\n" + end + rest.split(end, 1)[1]
    return page


def run(name):
    with tempfile.TemporaryDirectory() as directory:
        subprocess.run([str(TOP / "build/release/exemplar"), "study", str(STUDIES / f"{name}.prm"), "--quiet",
                        "--output", f"{directory}/{name}"], check=True)
        shutil.copy(f"{directory}/{name}/study.csv", FILES / f"{name}.csv")
        if Path(f"{directory}/{name}/study.svg").exists():
            shutil.copy(f"{directory}/{name}/study.svg", FIGURES / f"{name}.svg")


def main():
    if sys.argv[1:2] == ["--run"]:
        for name in sys.argv[2:] or sorted(file.stem for file in STUDIES.glob("*.prm")):
            print(name, file=sys.stderr, flush=True)
            run(name)
        return
    page = PAGE.read_text()
    right = page_with_tables(page)
    missing = [file.stem for file in STUDIES.glob("*.prm") if not (FILES / f"{file.stem}.csv").exists()]
    if missing:
        sys.exit(f"doc/studies has no results of {', '.join(sorted(missing))}: python3 doc/study_tables.py --run NAME")
    if sys.argv[1:] == ["--write"]:
        PAGE.write_text(right)
    elif page != right:
        sys.exit("doc/results.md has other numbers than doc/studies/*.csv: python3 doc/study_tables.py --write")
    print("doc/results.md has the numbers of doc/studies")


if __name__ == "__main__":
    main()
