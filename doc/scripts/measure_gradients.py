# SPDX-License-Identifier: GPL-3.0-or-later
"""How far gradients are off central differences of fourth order: for each combination of motion, element, rule of weights,
energy and law, on a tiny bar, the greatest relative difference along a random direction by each parameter.

Usage: PYTHONPATH=build/release/python /usr/bin/python3 doc/scripts/measure_gradients.py [PART]...     from anywhere
PART is statics, increments, euler, bdf2, laws or guards; all of them by default.
"""
import itertools
import sys
import warnings
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests/python"))
import test_gradients as equilibria  # noqa: E402
import test_gradients_of_laws as laws  # noqa: E402
import test_trajectory as motions  # noqa: E402

from scene_runs import print_table  # noqa: E402

KEYS = ["young", "poisson", "density", "importance", "poses", "rest_positions", "handles", "handles_of_steps", "nodal_forces",
        "gravity", "mass_damping", "stiffness_damping", "initial_positions", "initial_velocities"]
ELEMENTS = {"P1 cells": {"Dilatation": "cells"}, "P1 patches": {"Dilatation": "patches"}, "P2": {"Element": "P2"}}
ENERGIES = "scaled", "blended"
BY_TIME = {**laws.PRESCRIBED, "Prescribed weights": "0.1+t; 0.2; 0.3-t; 0.4"}
STEPS = 1e-2, 2e-3, 2e-4, 3e-5, 5e-6, 1e-6


def static(**sections):
    return equilibria.Case(equilibria.scene(**sections))


def increments(goals=motions.GOALS, **sections):
    """Three, with a load that grows."""
    base = motions.scene({**motions.SCENE, "Scene": "static", "Time": {"Increments": 3}, "Solver": {"Tolerance": 1e-12}}, **sections)
    return motions.Case(motions.scene(base, Loads={"Ramp": "increments"}), lengths=3 * [None], goals=goals)


def motion(scheme, damping, goals=motions.GOALS, **sections):
    """Of 20 steps."""
    return motions.Case(motions.scene(Time={"Scheme": scheme, **damping}, **sections), goals=goals)


MOTIONS = {"static": static, "increments": increments,
           "Euler": lambda **keys: motion("implicit euler", {}, **keys), "Euler, damped": lambda **keys: motion("implicit euler", motions.DAMPED, **keys),
           "BDF2": lambda **keys: motion("bdf2", {}, **keys), "BDF2, damped": lambda **keys: motion("bdf2", motions.DAMPED, **keys)}
THROUGH_STEPS = "increments", "Euler, damped", "BDF2, damped"
LAWS = {"fibres": {"Material": laws.FIBRES}, "orthotropy": {"Material": laws.ORTHOTROPY},
        "neo-Hookean": {"Model": {"Background": "neo-hookean"}, "Examples": {"Energy": "blended"}},
        "linear": {"Model": {"Strain": "linear"}}, "Green": {"Model": {"Strain": "green"}},
        **{f"acts on {part}": {"Examples": {"Acts on": part, "Weights": "free"}, "Material": laws.FIBRES} for part in
           ("shape", "volume", "along fibres", "across fibres")},
        "own modulus": {"Examples": {"Example modulus": 3e4, "Energy": "blended"}},
        "own ratio": {"Examples": {"Example Poisson ratio": 0.2, "Energy": "blended"}},
        "own, fibres": {"Examples": {"Example modulus": 2e5, "Example Poisson ratio": 0.1, "Energy": "blended"}, "Material": laws.FIBRES},
        "importance by region": {"Material": {"region 2": {"Importance factor": 0.6}}}}
PINCHES = {"collapsed": (0.9, 0.08), "stretched": (3.3, 0.05)}


def merged(*all_sections):
    result = {}
    for sections in all_sections:
        for name, keys in sections.items():
            result[name] = {**result.get(name, {}), **keys}
    return result


def difference(case, function, at, direction):
    """Of those steps between which it changes least, and over which the same weights are at their bounds in all motions."""
    found = []
    for step in STEPS:
        case.are_at_bounds = set()
        value = motions.difference(function, at, direction, step)
        if len(case.are_at_bounds) <= 1:
            found.append(value)
    return min(zip(found, found[1:]), key=lambda pair: abs(pair[0] - pair[1]))[1]


def differences(case):
    """{key: relative difference}"""
    result = {}
    for key, (at, *_, function) in case.parameters().items():
        if key not in case.found:
            continue
        direction = case.direction(key)
        expected = difference(case, function, at, direction)
        result[key] = abs(case.derivative(key, direction) - expected) / abs(expected)
    return result


def rules_of(name):
    """{rule: section of the scene}"""
    if name == "static":
        return {**motions.RULES, "prescribed": laws.PRESCRIBED}
    return motions.RULES


def by_rules(names):
    for name, (element, model), energy in itertools.product(names, ELEMENTS.items(), ENERGIES):
        for rule, examples in rules_of(name).items():
            yield (name, element, rule, energy), name, {"Model": model, "Examples": {**examples, "Energy": energy}}


def by_laws():
    for name, (law, sections), (element, model) in itertools.product(["static", *THROUGH_STEPS], LAWS.items(), ELEMENTS.items()):
        if law == "Green":
            if element == "P1 patches":
                continue
            model = {**model, "Dilatation": "cells"}
        yield (name, element, law, ""), name, merged(sections, {"Model": model})


def by_guards():
    for name, (pinch, sizes), (element, model) in itertools.product(THROUGH_STEPS, PINCHES.items(), ELEMENTS.items()):
        goals = laws.pinched(*sizes)(motions.NODES) - motions.NODES
        for law in "isotropic", "orthotropy", "neo-Hookean":
            sections = merged(LAWS.get(law, {}), {"Model": model, "Examples": BY_TIME})
            yield (name, element, law, pinch), name, {**sections, "goals": goals}


PARTS = {"statics": lambda: by_rules(["static"]), "increments": lambda: by_rules(["increments"]),
         "euler": lambda: by_rules(["Euler", "Euler, damped"]), "bdf2": lambda: by_rules(["BDF2", "BDF2, damped"]),
         "laws": by_laws, "guards": by_guards}


def main():
    warnings.simplefilter("ignore")
    greatest, n = {}, 0
    print("| motion | element | weights or law | energy or guard |", " | ".join(KEYS), "| greatest |")
    print("|" + (5 + len(KEYS)) * "---|")
    for part in sys.argv[1:] or PARTS:
        for words, name, sections in PARTS[part]():
            found = differences(MOTIONS[name](**sections))
            print("|", " | ".join(words), "|", " | ".join(f"{found[key]:.0e}" if key in found else "" for key in KEYS),
                  f"| {max(found.values()):.1e} |", flush=True)
            greatest = {key: max(greatest.get(key, 0), found.get(key, 0)) for key in {**greatest, **found}}
            n += 1
    print(f"\n{n} combinations")
    print_table(["parameter", "greatest"], *([key, f"{greatest[key]:.1e}"] for key in KEYS if key in greatest))
    print(f"Greatest of all: {max(greatest.values()):.1e}")


if __name__ == "__main__":
    main()
