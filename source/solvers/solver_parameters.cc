// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/linear_prediction.h>
#include <exemplar/prm/key_table.h>
#include <exemplar/solvers/solver_parameters.h>

namespace Exemplar
{
  namespace
  {
    const EnumTable<Method> methods = { { Method::automatic, "auto" },
                                        { Method::one_pass, "one pass" },
                                        { Method::fixed_point, "fixed point" },
                                        { Method::newton, "newton" },
                                        { Method::quasi_newton, "quasi newton" } };

    const EnumTable<LinearSolver> linear_solvers = { { LinearSolver::automatic, "auto" },
                                                     { LinearSolver::cholesky, "cholesky" },
                                                     { LinearSolver::cholmod, "cholmod" },
                                                     { LinearSolver::iterative, "iterative" },
                                                     { LinearSolver::umfpack, "umfpack" } };

    const EnumTable<Starts> all_starts
        = { { Starts::state, "state" }, { Starts::examples, "examples" } };

    const EnumTable<PassRotations> pass_rotations
        = { { PassRotations::last, "last" }, { PassRotations::predicted, "predicted" } };
  } // namespace

  void
  SolverParameters::declare(KeyTable &keys)
  {
    keys.enter_subsection("Solver");
    keys.add(
        "Method", method, methods,
        "one pass: the paper's, one linear solve with frozen rotations a step; fixed "
        "point: the same, repeated until the residual is below Tolerance; newton: descent on "
        "the energy with its exact tangent, or as much of a convex one as it takes; quasi newton: "
        "descent with the factor, or the multigrid hierarchy, of an earlier step, for dynamic "
        "scenes, to Step tolerance; auto: quasi newton in dynamic scenes, but those of shells that "
        "meet obstacles, newton in others, fixed point with frozen forces, for which nothing else "
        "converges.");
    keys.add(
        "Tolerance", tolerance,
        "Relative residual at which a step has converged: the greatest free residual "
        "force over the greatest nodal force scale. With newton, in static scenes and "
        "interpolations, also the error of the positions over the body's size, estimated by a "
        "further step with the same matrix. Of one pass, which does not converge, the residual of "
        "its linear solve where conjugate gradients make it, 1e-8 at most.",
        Bounds{ 1e-16, 1. });
    keys.add("Step tolerance", step_tolerance,
             "Error of the positions at which a step of quasi newton has converged, "
             "over the greatest displacement in this step; its relative residual must be "
             "as small, too. It has converged at Tolerance as well. Not used by other methods.",
             Bounds{ 0., 1. });
    keys.add("Maximum iterations", maximum_iterations,
             "Iterations after which a step without convergence ends the run with status "
             "2; newton first tries half the step, up to six times, with as many each, or goes "
             "on for eight times as many where nothing moves or changes. Not used by one pass.",
             Bounds{ 1 });
    keys.add(
        "Starts", starts, all_starts,
        "From where static scenes with examples look for their equilibrium: state: where the steps "
        "lead to; examples: after the last increment from each example, too, turned and moved to "
        "the held nodes, which stay at their places. That of least energy is kept.");
    keys.add(
        "Rotations", rotations, pass_rotations,
        "Rotations of the cells in one pass, and in the first pass of fixed point: last: those of "
        "the last step's positions, as in the paper; predicted: those of positions that the last "
        "velocities predict, for dynamic scenes. Not used by other methods.");
    keys.add(
        "Linear solver", linear_solver, linear_solvers,
        "cholesky: the positions' block is factorised, the weights follow from a "
        "dense Schur complement; iterative: the same with conjugate gradients and algebraic "
        "multigrid in place of the factor, for large meshes; cholmod: the factor is CHOLMOD's, for "
        "checking; umfpack: the whole bordered matrix at once, for checking; auto: cholesky, or "
        "iterative where that is faster by the count of operations, in compact bodies from about "
        "40,000 degrees of freedom.");
    keys.add(
        "Prediction order", prediction_order,
        "Of how many past velocities quasi newton, and passes with Rotations = predicted, predict "
        "the "
        "next ones. Five are best for motions that are smooth in time; fewer for those that are "
        "not: exemplar live sets 3.",
        Bounds{ 1, LinearPrediction::max_order });
    keys.add("Background factor", background_factor,
             "Whether quasi newton has new factors made by a thread beside its steps, which go on "
             "with the last one for a number of steps that follows from the count of operations: "
             "results do not "
             "depend on the thread. exemplar live sets it. Not used with iterative.");
    keys.leave_subsection();
  }

  std::string
  method_name(const Method method)
  {
    return enum_name(method, methods);
  }
} // namespace Exemplar
