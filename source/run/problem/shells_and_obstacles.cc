// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/number_text.h>
#include <exemplar/obstacles/obstacle_gaps.h>
#include <exemplar/run/problem/obstacle_start.h>

#include <fmt/core.h>

#include <algorithm>

namespace Exemplar
{
  void
  leave_room_for_shell(Obstacles                 &obstacles,
                       const ObstaclesParameters &parameters,
                       const ContactSurface      &surface,
                       const TimeAxis            &axis,
                       std::vector<std::string>  &notes)
  {
    constexpr unsigned int most_times = 50; // to look at
    constexpr double least_part = 0.05;     // of the usual distance, so that barriers are no walls
    const double     thickness  = 2. * surface.greatest_offset();
    if (parameters.distance != "auto" || thickness == 0.)
      return;
    std::vector<double> times;
    const unsigned int  stride = 1 + axis.n_steps() / most_times;
    for (unsigned int step = 0; step <= axis.n_steps(); step += stride)
      times.push_back(axis.time(step));
    const double usual = obstacles.width;
    const auto   gap   = narrowest_gap(obstacles.all, times, thickness, 2. * usual + thickness);
    if (!gap)
      return;
    for (double &width : obstacles.widths.of_pieces)
      width = std::min(width, std::max(0.5 * (gap->size - thickness), least_part * width));
    obstacles.width = obstacles.widths.greatest();
    notes.push_back(fmt::format(
        "Obstacles/{} and Obstacles/{} are {} m apart, and the shell is up to {} m thick: so that "
        "it "
        "has room between them, Obstacles/Distance = auto is {} m instead of {} m",
        obstacles.all[gap->first].name(), obstacles.all[gap->second].name(), short_text(gap->size),
        short_text(thickness), short_text(obstacles.width), short_text(usual)));
  }

  CompleteScene
  with_factor_beside_barriers(CompleteScene scene)
  {
    if (scene.mesh.kind != MeshKind::shell || scene.obstacles.empty()
        || scene.solver.linear_solver != LinearSolver::iterative)
      return scene;
    scene.solver.linear_solver = LinearSolver::cholesky;
    scene.warnings.push_back(
        "Solver/Linear solver = iterative does not converge for a shell that touches obstacles: "
        "multigrid in single precision does not tell its bending from their barriers, which are "
        "millions of times as stiff. cholesky is used instead. Set Linear solver = auto.");
    return scene;
  }
} // namespace Exemplar
