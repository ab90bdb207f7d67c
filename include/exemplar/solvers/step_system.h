// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_step_system_h
#define exemplar_step_system_h

#include <exemplar/algebra/bordered_system.h>
#include <exemplar/base/step_clock.h>
#include <exemplar/potential/incremental_potential.h>
#include <exemplar/solvers/background_factor.h>

#include <functional>
#include <memory>
#include <vector>

namespace Exemplar
{
  /// The linear system of a step, Eq. (10), made of the potential's tangent and solved for changes
  /// of positions and weights.
  class StepSystem
  {
  public:
    /// Makes a bordered system for the potential's pattern and free degrees of freedom as they are.
    using MakeSystem = std::function<std::unique_ptr<BorderedSystem>()>;

    /// `n_turning`: with others than 0 the held degrees of freedom only keep A regular, and steps are freed of
    /// the rigid motion of so many nodes, the first ones. The potential and the clock must outlive the system.
    StepSystem(IncrementalPotential &potential,
               MakeSystem            make_system,
               StepClock            &clock,
               unsigned int          n_turning);

    /// Assemble at these positions and weights, with the rotations as they are, and factorise.
    /// `convexity` as for PotentialTangent::assemble(). Throws SolverFailure if the matrix is
    /// not positive definite.
    void
    factorize(const Vector &positions, const std::vector<double> &weights, double convexity);

    /// factorize() after a small change within a step, as SpdOperator::factorize_near().
    void
    factorize_near(const Vector &positions, const std::vector<double> &weights, double convexity);

    /// Let what the last factor has of an earlier matrix be made anew, with its columns: a step begins as after a
    /// resume. `positions` are those of the last factor.
    void
    forget_earlier(const Vector &positions);

    /// factorize() in few digits: for BorderedSystem::keep(), the columns of weights, and callers that measure the
    /// residual of a solution.
    void
    factorize_roughly(const Vector              &positions,
                      const std::vector<double> &weights,
                      double                     convexity);

    /// Assemble the convex tangent without the terms that have gaps, and factorise roughly: for an inverse that is kept.
    void
    factorize_metric(const Vector &positions, const std::vector<double> &weights);

    /// Assemble as factorize_metric() does, and let a thread factorise roughly while the last factor is in use. False, with
    /// nothing done, for a system that cannot.
    bool
    begin_metric(const Vector &positions, const std::vector<double> &weights);

    /// From now on the factor of the last begin_metric() is in use, for which this waits. Returns its
    /// inverse_columns(). Throws SolverFailure if there is none.
    std::vector<double>
    take_factor();

    /// The step that takes the derivatives of `evaluation`, made at `at`, to zero by the last
    /// factor; `accuracy` as in BorderedSystem::solve(). Throws SolverFailure if the weights are not determined.
    BorderedVector
    solve(const State &at, const Evaluation &evaluation, const double accuracy = 0.)
    {
      return solve(at, evaluation.gradient, evaluation.elastic.weight_gradient, accuracy);
    }

    /// Solve for any derivatives: by degree of freedom [N] and, with weights to find, by weight [J].
    BorderedVector
    solve(const State               &at,
          const Vector              &gradient,
          const std::vector<double> &weight_gradient,
          double                     accuracy = 0.);

    /// As BorderedSystem::iterates().
    bool
    iterates() const
    {
      return system->iterates();
    }

    /// Solve for all columns of the weights now, as the first solve() would.
    void
    prepare();

    /// Displacements of a step by degree of freedom [m].
    Vector
    displacement(const State &at, const BorderedVector &step) const;

    /// Add a step.
    void
    add(const BorderedVector &step, State &state) const;

    /// The derivative of the potential along a step at fixed weights [J].
    double
    slope(const Evaluation &evaluation, const BorderedVector &step) const;

    /// Whether solve() has a factor: there was one since the free degrees of freedom changed.
    bool
    has_factor() const
    {
      return factor_of == potential.get_free_dofs().version();
    }

    /// Factorisations so far. Whoever remembers this number knows whether the factor is still his.
    unsigned int
    n_factorizations() const
    {
      return factorizations;
    }

    /// Factorisations so far without those that were remade after a resume.
    unsigned int
    n_new_factorizations() const
    {
      return factorizations - remade;
    }

    /// The last factorisation was one that the run had made before it was resumed.
    void
    count_as_remade()
    {
      ++remade;
    }

    BorderedSystem &
    bordered()
    {
      return *system;
    }

    const BorderedSystem &
    bordered() const
    {
      return *system;
    }

    /// What weights add to the systems: their columns, H and N; in bytes.
    std::size_t
    memory_of_weights() const;

  private:
    void
    factorize_by(void (BorderedSystem::*how)(const Vector &), const Vector &positions);

    /// Have a system for the pattern as it is.
    void
    follow_pattern();

    /// Assemble in the system whose factor comes next.
    void
    assemble(const Vector              &positions,
             const std::vector<double> &weights,
             double                     convexity,
             PotentialTangent::Terms    terms);

    /// Assemble in `assembled`, a system of the present pattern.
    void
    assemble(const Vector              &positions,
             const std::vector<double> &weights,
             double                     convexity,
             PotentialTangent::Terms    terms,
             BorderedSystem            &assembled);

    void
    count_factor();

    IncrementalPotential           &potential;
    const MakeSystem                make_system;
    std::unique_ptr<BorderedSystem> system;
    unsigned int                    pattern_version, dofs_version; ///< of the system
    StepClock                      &clock;
    const unsigned int              n_turning;
    BackgroundFactor                background;
    unsigned int                    factorizations = 0, remade = 0;
    unsigned int                    factor_of = 0; ///< FreeDofs::version(); 0: none was made
  };
} // namespace Exemplar

#endif
