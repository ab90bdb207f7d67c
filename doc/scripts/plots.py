# SPDX-License-Identifier: GPL-3.0-or-later
"""How all plots of the pages look: the palette, the place of the legend, the call of gnuplot (Debian: gnuplot-nox)."""
import subprocess

BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY = "#0072b2", "#d55e00", "#009e73", "#aa4499", "#e69f00", "#56b4e9"
BLACK, GREY = "#000000", "#777777"
# Colours that the colour-blind can tell apart, after Okabe and Ito, without their yellow, which is faint on white.
# exemplar study has the same (source/study/study_report.cc); tests/scenes/test_study.py compares.
PALETTE = (BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY, BLACK, GREY)
MARKS = (7, 5, 9, 11, 13)  # of gnuplot: a disc, a square, triangles up and down, a diamond


def line(number, variant=0):
    """Style of a curve with a mark at each point; curves of one number have one colour, of one variant one dash and mark."""
    return (f"linespoints lw 2 dt {1 + variant} pt {MARKS[variant % len(MARKS)]} ps 0.8 "
            f"lc rgb '{PALETTE[number % len(PALETTE)]}'")


def smooth(colour, dash=1):
    """Style of a curve without marks."""
    return f"lines lw 2 dt {dash} lc rgb '{colour}'"


def quoted(text):
    return "'" + text.replace("'", "''") + "'"


def gnuplot(file, size, commands):
    """Let gnuplot draw an svg of (width, height) in pixels of a page."""
    head = (f"set terminal svg noenhanced size {size[0]},{size[1]} font 'sans-serif,15' background 'white'\n"
            f"set output {quoted(str(file))}\nset grid\n")
    subprocess.run(["gnuplot"], input=head + commands + "\n", text=True, check=True)
    print(f"wrote {file}", flush=True)


def curves(lines):
    """Commands that plot (title, style, [(x, y), ...])."""
    data = "".join(f"$line{i} << EOD\n" + "\n".join(f"{x:.9g} {y:.9g}" for x, y in points) + "\nEOD\n"
                   for i, (_, _, points) in enumerate(lines))
    return data + "plot " + ", ".join(f"$line{i} with {style} " + (f"title {quoted(title)}" if title else "notitle")
                                      for i, (title, style, _) in enumerate(lines))


def plot(file, settings, lines, size=(800, 560)):
    """A plot with its legend below, where it covers no curve and leaves the curves the whole width."""
    gnuplot(file, size, f"set key below center Left reverse samplen 3 height 1\n{settings}\n{curves(lines)}")


def pareto_front(points):
    """The points that no other beats in both coordinates."""
    front = []
    for x, y in sorted(points):
        if not front or y < front[-1][1]:
            front.append((x, y))
    return front


def plot_study(file, runs):
    """Error against run time, as exemplar study draws it: runs are (values of the settings that tell curves apart, seconds, error).
    The last of the values chooses the colour, the others dash and mark."""
    keys = list(dict.fromkeys(key for key, _, _ in runs))
    colours = list(dict.fromkeys(key[-1] for key in keys))
    variants = list(dict.fromkeys(key[:-1] for key in keys))
    lines = [(", ".join(key), line(colours.index(key[-1]), variants.index(key[:-1])),
              [(x, y) for other, x, y in runs if other == key]) for key in keys]
    front = pareto_front([(x, y) for _, x, y in runs])
    lines.append(("Pareto front", f"points pt 6 ps 1.8 lw 2 lc rgb '{BLACK}'", front))
    plot(file, "set logscale xy\nset format '%g'\nset xlabel 'seconds of time stepping'\n"
         "set ylabel 'position error at the end (L2, relative)'", lines, (800, 600))
