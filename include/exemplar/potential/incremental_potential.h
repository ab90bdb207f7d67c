// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_incremental_potential_h
#define exemplar_incremental_potential_h

#include <exemplar/body/example_weights.h>
#include <exemplar/potential/potential_tangent.h>

#include <vector>

namespace Exemplar
{
  /// What is left of the equations at a state, relative to the forces there, Eq. (13).
  struct Residual
  {
    double              positions = 0.; ///< greatest free force over the greatest force scale
    double              weights   = 0.; ///< of the weights' conditions
    std::vector<double> multipliers;    ///< of each region's sum of unknown weights [J]
  };

  /// -part f.(x - x_0) with forces f [N] and the positions x_0 [m] at which the gradient of the
  /// potential is f: for part = 1 the body is at rest there. Nothing is held back at first.
  class HeldBackForces
  {
  public:
    /// All of `gradient` that acts on free degrees of freedom, until let_go().
    void
    hold(const FreeDofs &free_dofs, const Vector &gradient, const Vector &positions);

    void
    set_part(const double new_part)
    {
      part = new_part;
    }

    void
    let_go()
    {
      *this = {};
    }

    /// Add it to the potential at these positions and to its gradient.
    void
    add(const Exchange &exchange, const Vector &positions, Evaluation &evaluation) const;

  private:
    double part = 0.;
    Vector forces, origin;
  };

  /// What a step minimises over positions and weights: Phi(x, w), Eqs. (5), (12) and (22), the sum
  /// over the body and then the terms, in the order given.
  class IncrementalPotential
  {
  public:
    /// `integrator` is null unless the scene is dynamic. The terms are nobody else's; all else must outlive the potential. If `in_parts`, the
    /// pattern is without the couplings of outer products.
    IncrementalPotential(ElasticBody    &body,
                         ExampleWeights &weights,
                         const FreeDofs &free_dofs,
                         PotentialTerms  terms,
                         TimeIntegrator *integrator,
                         bool            in_parts = false);

    /// One more term; one that couples nodes needs
    /// PotentialTangent::renew_pattern().
    void
    add_term(std::unique_ptr<PotentialTerm> term);

    /// Material, masses or the importance of the examples are others from now on.
    void
    follow_parameters();

    /// A step of length h [s] (of dynamics; not used otherwise) begins at `start`.
    void
    begin_step(const State &start, double step_size);

    /// An iteration begins at this state, of which the evaluation must be: terms may change, PotentialTerm::renew().
    /// those with gaps only if the step is solved but for such changes. Where they do, pattern and evaluation follow. All
    /// processes must call this.
    TermChange
    renew(const State &at, Evaluation &evaluation, bool is_solved);

    /// The end of the step that has begun, of which the rotations are, gets what the laws remember.
    void
    remember(State &end);

    /// The step is accepted, with this end, which knows what the laws remember and gets what the step has dissipated.
    void
    end_step(State &end);

    /// States are evaluated without a step that leads to them, this one first: before the first step,
    /// after a resume, or after a rigid motion.
    void
    leave_step(const State &at);

    /// Loads and prescribed weights of time t [s]. `state` gets the time and, if they are
    /// prescribed, the weights.
    void
    set_time(double time, State &state);

    /// The same of the terms alone: their tangents may depend on it.
    void
    set_time_of_terms(double time);

    /// Whether the loads or prescribed weights of time t [s] are others than those of a state.
    bool
    is_driven(const State &from, double time) const;

    /// Everything at a state. Throws nothing: whoever needs finite numbers asks residual().
    void
    evaluate(const State &at, RotationUse rotations, Evaluation &evaluation);

    /// Unknown weights become the best ones for the positions, then as evaluate(). Throws
    /// SolverFailure if they are not determined.
    void
    minimize_over_weights(State &at, RotationUse rotations, Evaluation &evaluation);

    /// Sum cells, as they are in `evaluation`, and terms at these positions.
    void
    add_terms(const Vector &positions, Evaluation &evaluation) const;

    /// Throws SolverFailure if it is not finite.
    Residual
    residual(const State &at, const Evaluation &evaluation) const;

    /// x_hat in a step of dynamics, else null.
    const Vector *
    inertial_positions() const
    {
      return in_dynamic_step ? &integrator->predicted_positions() : nullptr;
    }

    /// PotentialTerm::weakly_constrained_pieces() of the term that has some.
    std::vector<unsigned int>
    weakly_constrained_pieces() const;

    /// Whether the tangent of a term depends on the step that has begun, PotentialTerm::has_tangent_of_step().
    bool
    has_tangent_of_step() const;

    /// Whether the forces at the same positions and weights differ from step to step: with prescribed
    /// weights, with stiffness damping, with creep of the weights, and where laws remember.
    bool
    changes_between_steps() const
    {
      return body.remembers() || weights.are_prescribed()
             || (in_dynamic_step
                 && (integrator->stiffness_damping_factor() > 0. || weights.get_memory().creeps()));
    }

    /// gamma (gamma + a_M), which multiplies the mass matrix in the tangent [1/s^2]; 0 in statics.
    double
    mass_factor() const
    {
      return integrator == nullptr ? 0. : integrator->mass_factor();
    }

    /// The part of a displacement [m] from these positions that a step may go: the least that a term
    /// allows, infinite where none asks.
    double
    max_step(const Vector &positions, const Vector &displacement) const;

    /// The same while obstacles go that part of the way to where they are at a time [s], PotentialTerm::max_step_to().
    double
    max_step_to(double time, const Vector &positions, const Vector &displacement) const;

    /// What does not allow all of it, PotentialTerm::limit_to(); empty if everything does.
    std::string
    limit_to(double time, const Vector &positions, const Vector &displacement) const;

    /// The greatest width of a gap [m]; 0 if no term has gaps.
    double
    gap_width() const;

    /// PotentialTerm::append_gaps() of all terms, of this process.
    std::vector<Gap>
    gaps(const Vector &positions, double range) const;

    /// PotentialTerm::append_gaps_along() of all terms that have gaps, of this process.
    std::vector<Gap>
    gaps_along(const Vector &positions, const Vector &displacement, double reach) const;

    /// PotentialTerm::append_gaps_of_way() of all terms, of this process.
    std::vector<Gap>
    gaps_of_way(double now, double time, const Vector &from, const Vector &to, double range) const;

    /// Obstacles stand where they are at a time [s] within the step.
    void
    move_to(double time);

    /// Whether obstacles stand elsewhere at these two times [s].
    bool
    moves_between(double time, double other_time) const;

    /// The name of a term that does not allow all of it; empty if all do.
    std::string
    name_of_limit(const Vector &positions, const Vector &displacement) const;

    /// Whether a term makes heat, which State::dissipated counts.
    bool
    has_dissipating_terms(const State &at) const;

    const ExampleWeights &
    get_weights() const
    {
      return weights;
    }

    const FreeDofs &
    get_free_dofs() const
    {
      return free_dofs;
    }

    /// The body, whatever it is made of.
    ElasticBody &
    get_body()
    {
      return body;
    }

    const ElasticBody &
    get_body() const
    {
      return body;
    }

    const PotentialTerms &
    get_terms() const
    {
      return terms;
    }

    HeldBackForces &
    get_held_back()
    {
      return held_back;
    }

    PotentialTangent &
    get_tangent()
    {
      return tangent;
    }

    const PotentialTangent &
    get_tangent() const
    {
      return tangent;
    }

  private:
    /// Let terms and pattern follow to where an iteration begins.
    TermChange
    renew_terms(const State &at, bool with_gaps);

    PotentialTerms   terms;
    ElasticBody     &body;
    PotentialTangent tangent; ///< of body and terms
    ExampleWeights  &weights;
    TimeIntegrator  *integrator;
    const FreeDofs  &free_dofs;
    HeldBackForces   held_back;
    bool             in_dynamic_step = false;
  };
} // namespace Exemplar

#endif
