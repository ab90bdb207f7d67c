# SPDX-License-Identifier: GPL-3.0-or-later
"""What the importance does: the bar of the README for several of them, in threads, as a table."""
from concurrent.futures import ThreadPoolExecutor

import exemplar

SCENE = """
set Scene = static
subsection Mesh
  set Generator = box
  set Box size = 4, 1, 1
  set Box cells = 16, 4, 4
end
subsection Examples
  set Pose functions = (8/pi-z)*sin(pi*x/8); y; 8/pi-(8/pi-z)*cos(pi*x/8)
  set Importance = IMPORTANCE
end
subsection Handles
  set Names = left, right
  subsection left
    set Select = boundary 1
  end
  subsection right
    set Select = boundary 2
    set Motion = 0; 0; t
    set Components = z
  end
end
subsection Time
  set Increments = 4
end
"""


def solve(importance):
    problem = exemplar.Problem(SCENE.replace("IMPORTANCE", str(importance)))
    problem.run()
    return problem


importances = [0, 0.25, 0.5, 0.75, 0.9]
with ThreadPoolExecutor(2) as threads:
    problems = list(threads.map(solve, importances))
print("importance   bent   pulled by [N]   drawn in [m]")
for importance, problem in zip(importances, problems):
    weight = problem.weights[1] if len(problem.weights) else float("nan")
    force = problem.statistics["reaction_right_z"]
    drawn_in = 4 - problem.positions[:, 0][problem.rest_positions[:, 0] == 4].mean()
    print(f"{importance:10.2f} {weight:6.3f} {force:15.1f} {drawn_in:14.3f}")
