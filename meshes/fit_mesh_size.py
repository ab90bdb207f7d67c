#!/usr/bin/env python3
"""Find the two mesh sizes of a .geo script that give wanted node and cell counts.

usage: fit_mesh_size.py FILE.geo CELLS NODES [TOLERANCE [MAX_RUNS]]
   eg: fit_mesh_size.py cat.geo 10212 2860 0.005

The script must define, by DefineConstant, hs (size on the skin) and hi (size
inside the body); their defaults are the starting point.  hs mostly moves the
node count, hi the number of cells per node.  Each trial runs

    gmsh -3 FILE.geo -o TEMPORARY.msh -setnumber hs .. -setnumber hi ..

(deterministic), and the sizes are moved by Broyden's method on the logarithms.
When that stalls, because the counts are not smooth functions of the sizes, the
neighbourhood of the best point is sampled with a fixed random sequence.  The
search stops once both counts are within TOLERANCE (relative, default 0.005) or
after MAX_RUNS (default 40), and prints the best sizes; put them into the .geo
file as the new defaults.
"""
import math
import os
import random
import re
import subprocess
import sys
import tempfile


def counts(geo, hs, hi):
    """Numbers of tetrahedra and nodes of the mesh made with these sizes."""
    with tempfile.TemporaryDirectory() as folder:
        msh = os.path.join(folder, "trial.msh")
        subprocess.run(["gmsh", "-3", geo, "-o", msh, "-setnumber", "hs", hs,
                        "-setnumber", "hi", hi], stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL, check=True)
        with open(msh) as f:
            lines = f.read().split("\n")
    nodes = int(lines[lines.index("$Nodes") + 1])
    first = lines.index("$Elements") + 2
    elements = lines[first:lines.index("$EndElements")]
    return sum(e.split()[1] == "4" for e in elements), nodes


def defaults(geo):
    """Values of hs and hi written in the script."""
    text = open(geo).read()
    return [float(re.search(r"\b%s\s*=\s*\{([^,]*)," % k, text).group(1)) for k in ("hs", "hi")]


def solve2(a, b):
    d = a[0][0] * a[1][1] - a[0][1] * a[1][0]
    return [(b[0] * a[1][1] - a[0][1] * b[1]) / d, (a[0][0] * b[1] - a[1][0] * b[0]) / d]


def main(argv):
    if len(argv) < 4:
        sys.exit(__doc__)
    geo, cells, nodes = argv[1], int(argv[2]), int(argv[3])
    tolerance = float(argv[4]) if len(argv) > 4 else 0.005
    max_runs = int(argv[5]) if len(argv) > 5 else 40
    runs = []                                   # (error, hs, hi, cells, nodes)

    def residual(x):
        hs, hi = ("%.5f" % math.exp(v) for v in x)
        c, n = counts(geo, hs, hi)
        r = [math.log(c / cells), math.log(n / nodes)]
        runs.append((max(abs(v) for v in r), hs, hi, c, n))
        print("hs %s  hi %s  cells %d (%+.2f %%)  nodes %d (%+.2f %%)"
              % (hs, hi, c, 100 * (c / cells - 1), n, 100 * (n / nodes - 1)), flush=True)
        return r

    def done():
        return min(runs)[0] <= tolerance or len(runs) >= max_runs

    # Broyden, from the slopes measured with steps of 8 %
    x = [math.log(v) for v in defaults(geo)]
    r = residual(x)
    if not done():
        step = 0.08
        moved = [residual([x[0] + step, x[1]]), residual([x[0], x[1] + step])]
        jac = [[(moved[j][i] - r[i]) / step for j in (0, 1)] for i in (0, 1)]
    for _ in range(8):
        if done():
            break
        d = [max(-0.15, min(0.15, -v)) for v in solve2(jac, r)]
        x = [x[0] + d[0], x[1] + d[1]]
        new = residual(x)
        length = d[0] ** 2 + d[1] ** 2
        for i in (0, 1):
            miss = new[i] - r[i] - sum(jac[i][j] * d[j] for j in (0, 1))
            for j in (0, 1):
                jac[i][j] += miss * d[j] / length
        r = new
    # then sample around the best point
    rng = random.Random(1)
    while not done():
        best = min(runs)
        x = [math.log(float(v)) + rng.gauss(0, 0.5 * best[0]) for v in best[1:3]]
        residual(x)
    best = min(runs)
    print("best: hs = %s; hi = %s  (%d cells, %d nodes)" % best[1:])
    return 0 if best[0] <= tolerance else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv))
