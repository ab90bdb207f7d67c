// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_step_solver_h
#define exemplar_step_solver_h

#include <exemplar/base/step_clock.h>
#include <exemplar/body/handles.h>
#include <exemplar/potential/incremental_potential.h>
#include <exemplar/solvers/solve_report.h>
#include <exemplar/solvers/solver_parameters.h>
#include <exemplar/solvers/step_system.h>

#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>

#include <functional>
#include <memory>

namespace Exemplar
{
  /// Finds positions and example weights at the end of a step: interpolation, statics and dynamics
  /// are one minimisation.
  class StepSolver
  {
  public:
    virtual ~StepSolver() = default;

    /// Go from `state`, where `evaluation` was made, to time t [s] by a step of length h [s]
    /// (of dynamics; not used otherwise). If the report is a success, `state` is the new one and
    /// `evaluation` that of it; else `state` is as it was. Throws Interrupted, with `state` and everything that
    /// save() writes as they were.
    virtual SolveReport
    solve(State &state, Evaluation &evaluation, double time, double step_size)
        = 0;

    /// What earlier steps have left counts no more: a step has failed, or the body was moved.
    virtual void
    forget()
    {
    }

    /// What a resumed run needs beside the state to end in the same bytes.
    virtual void
    save(boost::archive::binary_oarchive & /*archive*/) const
    {
    }

    /// Throws what boost's archives throw.
    virtual void
    load(boost::archive::binary_iarchive & /*archive*/)
    {
    }

    /// The last Schur complement of the weights; empty if there was none.
    virtual const dealii::FullMatrix<double> &
    schur_complement() const = 0;

    /// Memory that it keeps from step to step, in bytes.
    virtual std::size_t
    memory_consumption() const
    {
      return 0;
    }

    /// Called after the evaluation of every iteration. If it returns false and the iteration does not end the step,
    /// the solver abandons the step with Interrupted.
    std::function<bool(const SolveReport &)> observe;

    /// Called between the parts of long iterations. If it returns false, the solver abandons the step with Interrupted.
    std::function<bool()> may_go_on;

  protected:
    /// Measure the residual, set the state's multipliers, and show the report to who observes.
    /// Returns whether to go on. Throws SolverFailure if the residual is not finite.
    bool
    report_iteration(const IncrementalPotential &potential,
                     const Evaluation           &evaluation,
                     State                      &state,
                     SolveReport                &report) const;
  };

  /// All must outlive the solver.
  std::unique_ptr<StepSolver>
  make_step_solver(const SolverParameters &parameters,
                   IncrementalPotential   &potential,
                   StepSystem             &system,
                   const Handles          &handles,
                   StepClock              &clock);
} // namespace Exemplar

#endif
