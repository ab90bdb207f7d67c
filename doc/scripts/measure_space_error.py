#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""How good Output/Space error is: its estimates over errors against refined references, doc/measured.md.

    /usr/bin/python3 doc/scripts/measure_space_error.py [bar] [cook] [cat] [lifted] [swing] [--program P]

Bar, Cook's membrane and cat are the bodies of prm/studies/space_*.prm. The truth of the energy is the limit in
doc/studies/space_limits.csv; that of the displacements is the program's P2 with the mean dilatation of a cell on a finer mesh, of
which the nodes of the coarse one are a part: boxes half as long or less, cook_64.geo, the cat with each cell cut in eight. The
errors compared are norms over the nodes of the coarse mesh. lifted is the bar of prm/studies/scenes/pulled.prm, its right end lifted
by a fifth of its length, with three examples of unknown weights; swing is prm/studies/scenes/bar.prm after 0.7 s, moving, with one.
With all bodies it writes doc/studies/space_error.csv. A quarter of an hour.
"""
import csv
import json
import subprocess
import sys
import tempfile
from pathlib import Path

from space_elements import np, read_mesh, refined

TOP = Path(__file__).resolve().parents[2]
FILE = TOP / "doc/studies/space_error.csv"
SCENES = TOP / "prm/studies/scenes"
MESHES = TOP / "prm/studies/meshes"
COARSE = {"bar": ("8, 2, 2", "16, 4, 4"), "cook": ("cook_8.geo", "cook_16.geo", "cook_32.geo"),
          "cat": ("cat_68mm.geo", "cat_48mm.geo"), "lifted": ("8, 2, 2", "12, 3, 3"), "swing": ("8, 2, 2", "12, 3, 3")}
SCENE = {"bar": "space_bar.prm", "cook": "cook.prm", "cat": "space_cat.prm", "lifted": "pulled.prm",
         "swing": "bar.prm"}
SETTINGS = {"lifted": {"Handles/right/Motion": "0; 0; 0.8*t", "Time/Increments": 4, "Examples/Weights": "free",
                       "Examples/Energy": "scaled", "Examples/Importance": 0.8}, "swing": {"Time/End": 0.7, "Time/Step": 0.02}}
COLUMNS = ["body", "mesh", "nu", "dilatation", "displacement", "displacement_true", "energy", "energy_true", "weights",
           "weights_true"]


def solve(program, body, mesh, nu, settings, folder):
    """Places of the nodes at the end, the last row of statistics.csv and summary.json."""
    key = "Mesh/File" if "." in mesh else "Mesh/Box cells"
    settings = {key: mesh, "Material/Poisson's ratio": nu, "Solver/Linear solver": "cholesky", "Output/Every": 0,
                **SETTINGS.get(body, {}), **settings}
    out = Path(folder) / "out"
    words = [word for name, value in settings.items() for word in ("--set", f"{name}={value}")]
    subprocess.run([program, SCENES / SCENE[body], "--quiet", "--output", out, *words], check=True)
    with open(out / "statistics.csv", newline="") as file:
        row = list(csv.DictReader(file))[-1]
    return places_of(out / "final.msh"), row, json.loads((out / "summary.json").read_text())


def places_of(file):
    lines = file.read_text().split("\n")
    start = lines.index("$Nodes")
    return np.array([line.split()[1:4] for line in lines[start + 2:start + 2 + int(lines[start + 1])]], float)


def write_msh(file, places, cells):
    """Cells alone, which is enough where a box selects the held nodes."""
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(places))]
    lines += [f"{i + 1} {x!r} {y!r} {z!r}" for i, (x, y, z) in enumerate(places.tolist())]
    lines += ["$EndNodes", "$Elements", str(len(cells))]
    lines += [f"{i + 1} 4 2 1 1 " + " ".join(str(v + 1) for v in cell) for i, cell in enumerate(cells.tolist())]
    file.write_text("\n".join(lines + ["$EndElements", ""]))


def mesh_of(program, body, mesh, folder):
    """Places at rest and cells, with the nodes numbered as in final.msh, and a finer mesh."""
    if body == "cat":
        places, cells = read_mesh(MESHES / mesh)
        coarse, fine = Path(folder) / "coarse.msh", Path(folder) / "fine.msh"
        write_msh(coarse, places, cells)
        write_msh(fine, *refined(places, cells))
        return str(coarse), str(fine)
    finer = {"8, 2, 2": "16, 4, 4", "12, 3, 3": "24, 6, 6", "16, 4, 4": "32, 8, 8"}
    return (mesh, finer[mesh]) if body != "cook" else (str(MESHES / mesh), str(MESHES / "cook_64.geo"))


def nodes_among(coarse, fine):
    """The index of each coarse place among the fine ones."""
    index = {tuple(np.round(place, 7) + 0.): i for i, place in enumerate(fine)}
    return np.array([index[tuple(np.round(place, 7) + 0.)] for place in coarse])


def rest_of(program, body, mesh, folder):
    """Places and cells at rest: final.msh of a scene on which nothing acts."""
    still = {"Loads/Gravity": "0, 0, 0"} if body in ("bar", "cat") else {"Loads/shear/Force": "0; 0; 0"} if body == "cook" else \
        {"Handles/right/Motion": "0; 0; 0", "Examples/Importance": 0}
    solve(program, body, mesh, 0.3, {**still, "Model/Dilatation": "cells"}, folder)
    return read_mesh(Path(folder) / "out/final.msh")


def volumes_of(places, cells):
    volume = np.abs(np.linalg.det(places[cells[:, 1:]] - places[cells[:, :1]])) / 6
    return np.bincount(cells.ravel(), np.repeat(volume / 4, 4), len(places))


def compare(program, body, mesh, nu, dilatation, limits, folder):
    coarse, fine = mesh_of(program, body, mesh, folder)
    rest, cells = rest_of(program, body, coarse, folder)
    rest_fine, _ = rest_of(program, body, fine, folder)
    x, row, summary = solve(program, body, coarse, nu, {"Model/Dilatation": dilatation, "Output/Space error": "true"}, folder)
    x_fine, row_fine, _ = solve(program, body, fine, nu, {"Model/Element": "P2", "Model/Dilatation": "patches"}, folder)
    volumes = volumes_of(rest, cells)[:, None]
    u_true = (x_fine - rest_fine)[nodes_among(rest, rest_fine)]
    error = np.sqrt((volumes * (x - rest - u_true) ** 2).sum() / (volumes * u_true ** 2).sum())
    estimate = summary["space_error"]
    result = {"body": body, "mesh": mesh, "nu": nu, "dilatation": dilatation, "displacement": estimate["displacement"],
              "displacement_true": error}
    if body in SETTINGS:
        weights = [name for name in row if name.startswith("weight_")]
        result["weights"] = estimate["weights"]
        result["weights_true"] = max(abs(float(row[name]) - float(row_fine[name])) for name in weights)
    else:
        limit = limits[body, mesh if body == "cat" else "", nu]
        result.update(energy=estimate["energy"], energy_true=1 - float(row["energy_elastic"]) / limit)
    return result


def main():
    words = sys.argv[1:]
    program = words[words.index("--program") + 1] if "--program" in words else str(TOP / "build/release/exemplar")
    bodies = [word for word in words if word in COARSE] or list(COARSE)
    with open(TOP / "doc/studies/space_limits.csv", newline="") as file:
        limits = {(row["body"], row["mesh"], float(row["nu"])): float(row["energy"]) for row in csv.DictReader(file)}
    rows = []
    for body in bodies:
        for mesh in COARSE[body]:
            for nu in (0.3, 0.45, 0.499):
                for dilatation in ("cells", "patches"):
                    with tempfile.TemporaryDirectory() as folder:
                        row = compare(program, body, mesh, nu, dilatation, limits, folder)
                    rows.append({name: f"{value:.4g}" if isinstance(value, float) and name != "nu" else value
                                 for name, value in row.items()})
                    ratios = {what: round(row[what] / row[what + "_true"], 3) for what in ("displacement", "energy", "weights")
                              if what in row}
                    print(body, mesh, nu, dilatation, ratios, rows[-1], flush=True)
    if bodies == list(COARSE):
        with open(FILE, "w", newline="") as file:
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)


if __name__ == "__main__":
    main()
