# SPDX-License-Identifier: GPL-3.0-or-later
"""Are the numbers of doc/studies those of the program as it is? Run studies again and name the rows that differ.

Usage: python3 doc/scripts/compare_studies.py [--keep] [NAME...]
NAME is a study of prm/studies or prm/tutorial, or the folder, `studies` or `tutorial`; all, if none is named. Exit status 1 if a
row differs. With --keep these rows replace those of doc/studies; then study_tables.py --write. The program is that of the variable
EXEMPLAR, or build/release/exemplar; a study goes on where it was stopped.
`cmake --build build/release --target tutorial_tables` (or studies_tables) builds the program first.

A row belongs to one of doc/studies with the same values of the varied keys. What depends on the machine is not compared: seconds,
memory, names of runs, wording of messages.
"""
import csv
import sys

from study_tables import FILES, STUDIES, axes, read, results

OF_THE_MACHINE = ("seconds_median", "seconds_min", "peak_memory_mib", "run", "message")
COUNTS = ("steps", "iterations", "factorizations", "inverted_cells", "exit_status")
OF_ROUNDING = ("residual", "kkt_residual", "energy_growth", "bound_excess")


def tolerance(column):
    """Relative and absolute: with another BLAS a long run may need an iteration more, errors keep the digits that pages show, and
    what is left of a residual below the solver's tolerance says nothing."""
    if column in COUNTS:
        return 0.01, 0
    return (1, 1e-6) if column in OF_ROUNDING else (0.01, 1e-9)


def number(text):
    try:
        return float(text)
    except ValueError:
        return None


def differs(column, kept, now):
    if kept == now or column in OF_THE_MACHINE:
        return False
    before, after = number(kept), number(now)
    if before is None or after is None:
        return True
    relative, absolute = tolerance(column)
    return abs(after - before) > max(relative * max(abs(before), abs(after)), absolute)


def by_settings(rows):
    return {tuple(row[key] for key in axes(rows)): row for row in rows}


def difference(kept, now):
    """What differs between two rows of the same settings, "" if nothing does; a row that is missing is None. Columns that are not
    kept are on no page."""
    if not kept or not now:
        return "is no longer there" if kept else "is new"
    return "; ".join(f"{column} {value} -> {now.get(column, 'missing')}" for column, value in kept.items()
                     if differs(column, value, now.get(column, "missing")))


def keep(name, kept, now, changed):
    rows = [now[settings] if settings in changed else kept[settings] for settings in now]
    with open(FILES / f"{name}.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, list(next(iter(kept.values()))), lineterminator="\n", extrasaction="ignore")
        writer.writeheader()
        writer.writerows(rows)


def compare(name, keep_rows):
    """How many rows of a study differ."""
    kept, now = by_settings(read(name)), by_settings(results(name))
    changed = {}
    for settings in dict.fromkeys([*kept, *now]):
        what = difference(kept.get(settings), now.get(settings))
        if what:
            changed[settings] = what
            print(f"{name}, {', '.join(settings)}: {what}", flush=True)
    print(f"{name}: {len(changed)} of {len(now)} rows differ", flush=True)
    if changed and keep_rows:
        keep(name, kept, now, changed)
    return len(changed)


def chosen(words):
    """Studies by their names or folders."""
    unknown = [word for word in words if word not in STUDIES and word not in ("studies", "tutorial")]
    if unknown:
        sys.exit(f"no study: {', '.join(unknown)}. There are: {', '.join(STUDIES)}; studies, tutorial")
    return [name for name, file in STUDIES.items() if not words or name in words or file.parent.name in words]


def main():
    words = sys.argv[1:]
    keep_rows = "--keep" in words
    found = sum(compare(name, keep_rows) for name in chosen([word for word in words if word != "--keep"]))
    if found:
        sys.exit(f"{found} rows of doc/studies are not those of this program"
                 + ("; they are replaced: python3 doc/scripts/study_tables.py --write" if keep_rows else ""))
    print("doc/studies has the numbers of this program")


if __name__ == "__main__":
    main()
