// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_python_trajectory_h
#define exemplar_python_trajectory_h

#include <exemplar/python/problem_type.h>

namespace Exemplar::Python
{
  /// Whether a trajectory that is still there records the steps of a problem.
  bool
  is_recorded(const Problem &problem);

  /// Adds exemplar.Trajectory to the module, and problem.record(), which makes one.
  void
  add_trajectories(pybind11::module_ &module, ProblemClass &problem);
} // namespace Exemplar::Python

#endif
