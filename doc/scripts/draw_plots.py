#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw the plots of doc/figures from doc/studies.

Usage: python3 doc/scripts/draw_plots.py [NAME]...      all, if none is named; Debian: gnuplot-nox

NAME is space, time_to_error, growth_cells, growth_examples, roofline or a study of which a page shows the plot.
"""
import sys

from plots import BLACK, MARKS, PALETTE, curves, gnuplot, line, pareto_front, plot, plot_study, smooth
from study_tables import ELEMENTS, FIGURES, FILES, PAGES, STUDIES, axes, error, own_limit, read, space_runs

SPACE_BODIES = {"bar": "bar under its weight", "cook": "Cook's membrane", "cat": "cat", "horse": "horse"}
SPACE_NUS = ("0.3", "0.499")


def is_number(text):
    try:
        return bool(float(text) + 1)
    except ValueError:
        return False


def draw_study(name):
    rows = [row for row in read(name) if error(row) > 0 and float(row["seconds_median"]) > 0]
    words = [key for key in axes(rows) if not all(is_number(row[key]) for row in rows)]
    plot_study(FIGURES / f"{name}.svg",
               [(tuple(row[key] for key in words), float(row["seconds_median"]), error(row)) for row in rows])


def space_panel(body, nu):
    runs = [run for run in space_runs(f"space_{body}") if run[2] == nu]
    lines = []
    for number, element in enumerate(ELEMENTS.values()):
        points = [(seconds, abs(ratio - 1)) for mesh, of, _, ratio, seconds in runs
                  if of == element and not own_limit(body, mesh, element, runs)]
        lines.append((element, line(number), points))
    return lines


def draw_space():
    """Error of the deflection against seconds: a row a body, a column a ratio of Poisson, one legend above all."""
    width, height, top = 800, 280, 40
    total = top + height * len(SPACE_BODIES)
    commands = ["set multiplot", "set logscale xy", "set format '10^{%T}'", "unset mxtics", "unset mytics",
                "set xrange [5e-4:20]", "set yrange [1e-4:1]", "set lmargin 9", "set rmargin 2", "set bmargin 3.2", "set tmargin 2", "unset key"]
    commands += [f"set label {i + 1} '{element}' at screen {0.2 + 0.18 * i:g},{1 - top / 2 / total:.6g} point pt {MARKS[0]} "
                 f"lc rgb '{PALETTE[i]}' offset 1,-0.3" for i, element in enumerate(ELEMENTS.values())]
    for r, (body, title) in enumerate(SPACE_BODIES.items()):
        for c, nu in enumerate(SPACE_NUS):
            commands += [f"set size 0.5,{height / total:.6g}", f"set origin {0.5 * c:g},{(total - top - height * (r + 1)) / total:.6g}",
                         f'set title "{title}, ν = {nu}" offset 0,-0.5', "set xlabel 'seconds' offset 0,0.5",
                         "set ylabel 'error of the deflection'" if c == 0 else "set ylabel ' '",
                         curves(space_panel(body, nu)), "unset label"]
    gnuplot(FIGURES / "space.svg", (width, total), "set termoption enhanced\n" + "\n".join(commands))


def draw_time_to_error():
    """Error of space and step together against seconds: a panel a body, a line an element's best runs."""
    bodies = {"bar": "bar 4:1:1, lifted", "cat": "cat, soles turned"}
    commands = ["set multiplot layout 1,2", "set logscale xy", "unset mxtics", "unset mytics", "set format '%g'", "set lmargin 11",
                "set tmargin 4", "set xlabel 'seconds of time stepping'", "unset key"]
    for body, title in bodies.items():
        rows = read(f"time_to_error_{body}")
        elements = list(dict.fromkeys(row["element"] for row in rows))
        points = {(row["element"], number): (float(row["seconds_median"]), error(row)) for number, row in enumerate(rows)}
        lines = [(element, line(number), pareto_front([point for (of, _), point in points.items() if of == element]))
                 for number, element in enumerate(elements)]
        front = pareto_front(points.values())
        lines.append(("none is cheaper", f"points pt 6 ps 1.8 lw 2 lc rgb '{BLACK}'", front))
        commands += [f"set label {i + 1} '{name}' at screen {0.1 + 0.15 * i:g},0.96 point pt {MARKS[0] if name in elements else 6} "
                     f"lc rgb '{PALETTE[i] if name in elements else BLACK}' offset 1,-0.1" for i, (name, _, _) in enumerate(lines)]
        commands += [f"set title '{title}'", f"set ylabel '{'error of the positions' if body == 'bar' else ' '}'", curves(lines), "unset label"]
    gnuplot(FIGURES / "time_to_error.svg", (1000, 520), "\n".join(commands))


def draw_growth_cells():
    rows, lines = read("growth_cells"), []
    for number, (dilatation, title) in enumerate((("cells", "Dilatation = cells"), ("patches", "Dilatation = patches, the default"))):
        points = [(float(row["cells"]), 1e3 * float(row["ms_step"]) / float(row["cells"])) for row in rows
                  if row["dilatation"] == dilatation]
        lines.append((title, line(number), points))
    plot(FIGURES / "growth_cells.svg", "set logscale xy\nset xrange [1e3:2e6]\nset yrange [0.1:10]\nset xlabel 'cells'\n"
         "set ylabel 'microseconds a cell and step'\nset format x '%.0f'", lines, (640, 420))


def draw_growth_examples():
    points = [(float(row["examples"]), float(row["ratio"])) for row in read("growth_examples")]
    # k + 1 on the axis, so that none has a place on it
    ticks = ", ".join(f"'{count:.0f}' {count + 1:.0f}" for count, _ in points)
    plot(FIGURES / "growth_examples.svg", f"set logscale x\nset xrange [0.8:100]\nset xtics ({ticks})\nset yrange [0:16]\n"
         "set xlabel 'examples beside the rest pose'\nset ylabel 'time of a step, without examples 1'",
         [(None, line(0), [(count + 1, ratio) for count, ratio in points])], (640, 420))


def draw_roofline():
    """Operations a second of a step's parts against operations a byte, below what the machine can do."""
    best = {row["what"]: float(row["value"]) for row in read("machine")}
    peak = best["product of matrices, single precision, GFLOP/s"]
    roofs = [("reading 4 MiB", best["reading 4 MiB, GB/s"], 1), ("reading 512 MiB", best["reading 512 MiB, GB/s"], 2)]
    lines = [(f"{name}: {rate:.0f} GB/s; product of matrices: {peak:.0f} GFLOP/s", smooth(BLACK, dash),
              [(.1, .1 * rate), (peak / rate, peak), (1000, peak)]) for name, rate, dash in roofs]
    rows = read("roofline")
    parts = list(dict.fromkeys(row["part"] for row in rows))
    for variant, body in enumerate(dict.fromkeys(row["body"] for row in rows)):
        lines += [(f"{row['part']}, {body}", f"points pt {MARKS[variant]} ps 1.4 lc rgb '{PALETTE[parts.index(row['part'])]}'",
                   [(float(row["operations_per_byte"]), float(row["gflop_s"]))]) for row in rows if row["body"] == body]
    plot(FIGURES / "roofline.svg", "set logscale xy\nset xrange [.1:1000]\nset yrange [3:400]\nset format '%g'\n"
         "set xlabel 'operations a byte'\nset ylabel 'GFLOP/s'", lines, (800, 560))


def main():
    shown = [name for name in STUDIES if any(f"figures/{name}.svg" in page.read_text() for page in PAGES)]
    makers = {"space": draw_space, "time_to_error": draw_time_to_error, "growth_cells": draw_growth_cells, "growth_examples": draw_growth_examples, "roofline": draw_roofline}
    for name in sys.argv[1:] or [*shown, *makers]:
        makers.get(name, lambda: draw_study(name))()


if __name__ == "__main__":
    main()
