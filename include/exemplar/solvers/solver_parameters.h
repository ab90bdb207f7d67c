// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_solver_parameters_h
#define exemplar_solver_parameters_h

#include <string>

namespace Exemplar
{
  class KeyTable;

  /// How a step is solved.
  enum class Method
  {
    automatic,
    one_pass,
    fixed_point,
    newton,
    quasi_newton
  };

  /// The positions whose rotations a step's first pass takes: those of the last step, or predicted ones.
  enum class PassRotations
  {
    last,
    predicted
  };

  /// From where static scenes look for their equilibrium.
  enum class Starts
  {
    state,
    examples
  };

  /// How a linear system is solved.
  enum class LinearSolver
  {
    automatic,
    cholesky,
    cholmod,
    iterative,
    umfpack
  };

  /// Subsection Solver.
  struct SolverParameters
  {
    Method        method             = Method::automatic;
    double        tolerance          = 1e-8;
    double        step_tolerance     = 1e-3;
    unsigned int  maximum_iterations = 50;
    PassRotations rotations          = PassRotations::last;
    Starts        starts             = Starts::state;
    LinearSolver  linear_solver      = LinearSolver::automatic;
    unsigned int  prediction_order   = 5;
    bool          background_factor  = false;
    unsigned int  n_threads = 1; ///< at work; no key of scene files, as no result depends on it

    void
    declare(KeyTable &keys);
  };

  /// The method as scene files write it.
  std::string
  method_name(Method method);
} // namespace Exemplar

#endif
