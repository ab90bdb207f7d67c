// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_frozen_passes_h
#define exemplar_frozen_passes_h

#include <exemplar/solvers/motion_prediction.h>
#include <exemplar/solvers/step_solver.h>

namespace Exemplar
{
  /// The paper's method: linear solves with frozen rotations, one a step (one pass) or until
  /// nothing changes any more (fixed point).
  class FrozenPasses : public StepSolver
  {
  public:
    FrozenPasses(const SolverParameters &parameters,
                 IncrementalPotential   &potential,
                 StepSystem             &system,
                 const Handles          &handles,
                 StepClock              &clock);

    SolveReport
    solve(State &state, Evaluation &evaluation, double time, double step_size) override;

    void
    forget() override
    {
      prediction.forget();
    }

    void
    save(boost::archive::binary_oarchive &archive) const override;

    void
    load(boost::archive::binary_iarchive &archive) override;

    const dealii::FullMatrix<double> &
    schur_complement() const override
    {
      return system.bordered().schur_complement();
    }

  private:
    bool
    has_predicted_rotations() const
    {
      return parameters.rotations == PassRotations::predicted;
    }

    /// The forces at the end of the step with the rotations of its beginning.
    void
    begin_with_last_rotations(double time, State &trial, Evaluation &evaluation);

    /// The forces and the rotations at predicted positions.
    void
    begin_with_predicted_rotations(
        const State &accepted, double time, double step_size, State &trial, Evaluation &evaluation);

    void
    iterate(const Vector &linearized_at, State &trial, Evaluation &evaluation, SolveReport &report);

    const SolverParameters parameters;
    IncrementalPotential  &potential;
    StepSystem            &system;
    const Handles         &handles;
    StepClock             &clock;
    MotionPrediction       prediction;
  };
} // namespace Exemplar

#endif
