// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_touching_term_h
#define exemplar_touching_term_h

#include <exemplar/body/time_integrator.h>
#include <exemplar/obstacles/contact_surface.h>
#include <exemplar/potential/contact_forces.h>
#include <exemplar/potential/contact_slopes.h>
#include <exemplar/potential/friction_lag.h>
#include <exemplar/potential/potential_term.h>

#include <functional>
#include <utility>
#include <vector>

namespace Exemplar
{
  /// Barriers of pairs that are nearer than their width, and friction of those that rub, whatever the body touches, doc/contact.md.
  class TouchingTerm : public PotentialTerm
  {
  public:
    void
    attach(const SymmetricPattern &pattern, const FreeDofs &free_dofs) override;

    void
    follow_parameters() override
    {
      surface.set_material(material);
    }

    bool
    has_settled() const override
    {
      return rubbing_step().n_renewals <= max_renewals;
    }

    void
    append_gaps(const Vector &positions, double range, std::vector<Gap> &gaps) const override;

    void
    add(const TermPoint &at, ElasticSums &sums) override;

    void
    add_tangent(const TermPoint     &at,
                Tangent              kind,
                std::vector<double> &values,
                std::vector<double> &columns) override;

    void
    add_response(const TermPoint &at,
                 Tangent          kind,
                 const Vector    &displacement,
                 ElasticSums     &sums) override;

    double
    rounding_force(const Vector &positions) const override;

    /// Derivatives of the slope along a displacement, of barriers and of friction whose forces are those at these
    /// positions, in a mesh with this space. Set_time() must have told the time, and begin_step() the start where there
    /// is friction.
    virtual TouchingSlopes
    slopes(const Vector &positions, const Vector &along, const FESpace &fe_space) const = 0;

    /// Of barriers and friction on the nodes [N].
    Vector
    forces(const Vector &positions) const;

    static constexpr unsigned int max_renewals = 40; ///< of what rubs in a solution of a step

    /// What of friction belongs to the step that has begun.
    struct RubbingStep
    {
      double               size      = 0.;    ///< [s]
      bool                 has_begun = false; ///< and has not been left
      Vector               slip_base;         ///< of the body: x_star of the time scheme [m]
      double               rate = 0.; ///< gamma of the time scheme, or one over the step [1/s]
      std::vector<Rubbing> rubbing;   ///< since the last renewal, ascending
      unsigned int         n_renewals = 0;
      double      greatest_force      = 0.; ///< of the contacts with friction at the last look [N]
      FrictionLag lag;

      /// Another solution of the step begins, as after one that failed.
      void
      restart()
      {
        n_renewals = 0;
        lag.clear();
      }
    };

  protected:
    /// `integrator` is null unless the scene is dynamic. All must outlive the term.
    TouchingTerm(const ContactSurface &surface,
                 const Material       &material,
                 const TimeIntegrator *integrator,
                 const ContactPoints  &points = ContactPoints::none())
        : surface(surface), material(material), integrator(integrator), points(points)
    {
    }

    using VisitTouch = std::function<void(const Touch &)>;
    /// Of a touch or of what rubs: the number of the obstacle, the gap, and derivatives of the energy by its nodes [N].
    using VisitGradient
        = std::function<void(unsigned int obstacle, const Gap &, const ContactGradient &)>;

    /// Call visit(touch) for the pairs nearer than `range` times their width, in an order that the mesh decides.
    virtual void
    visit_touches(const Vector &positions, double range, const VisitTouch &visit) const = 0;

    virtual const RubbingStep &
    rubbing_step() const = 0;

    /// How the body's point has moved beside the other one in the step [m]: by its velocity as the time scheme has it, over the scheme's rate.
    virtual SpaceVector3
    motion_along(const Rubbing &at, const Vector &positions) const = 0;

    /// From which friction is that of a sliding contact [m/s].
    virtual double
    slip_speed(const Rubbing &at) const = 0;

    /// How a contact slips in the step.
    struct Slip
    {
      SpaceVector3 vector; ///< the motion across the normal [m]
      SpaceVector3 normal;
      /// Derivatives of the motion by the points of the gap; empty: coefficients times the unit matrix.
      std::vector<dealii::Tensor<2, 3>> by_points;
    };

    virtual Slip
    slip(const Rubbing &at, const Vector &positions) const;

    SlipEnergy
    slip_energy(const Rubbing &at) const
    {
      return { at.coefficient * at.force, slip_speed(at) / rubbing_step().rate };
    }

    /// What a step with this end makes of it [J].
    double
    heat_of(const Rubbing &at, const Vector &positions) const;

    /// Of all that rubs [J].
    double
    heat_of_all(const Vector &positions) const;

    /// The potential of all that rubs, which is no stored energy [J].
    double
    energy_of_friction(const Vector &positions) const;

    /// Append what the models of solvers know of friction.
    void
    append_gaps_of_friction(const Vector &positions, std::vector<Gap> &gaps) const;

    /// What would rub at a touch, if anything: without what the obstacle adds.
    static std::optional<Rubbing>
    rubbing_of(const Touch &touch, PairKey key, double coefficient);

    /// What rubs at the end of a solution, in ascending order, rubs in the next one, unless no normal force differs by more than this
    /// part of the greatest. All processes must call this.
    TermChange
    renew_friction(std::vector<Rubbing> now, double tolerance, RubbingStep &step) const;

    /// Tell a step from where slips count, which begins at this state; its size must be known.
    void
    remember_slip_base(const State &at, RubbingStep &step) const;

    /// What rubs slips from where the step counts it.
    ContactGradient
    gradient_of_friction(const Rubbing &at, const Slip &slip) const;

    /// Call visit for all barriers that are not closed, whose infinite energy has no force, and for all friction.
    void
    visit_gradients(const Vector &positions, const VisitGradient &visit) const;

    /// What touches at the end of a step; of this process.
    struct Reached
    {
      double barrier_energy = 0.; ///< [J]
      double least_gap;           ///< [m]
      double n_pairs      = 0.;
      double normal_force = 0.; ///< of all pairs [N]
    };

    /// With gaps of `width` at most.
    Reached
    reached_at(const Vector &positions, double width) const;

    /// In bytes.
    std::size_t
    memory_of_touching() const;

    ContactSurface          surface; ///< with the shares of the material
    const Material         &material;
    const TimeIntegrator   *integrator;
    const ContactPoints    &points;              ///< of gaps, in place of nodes
    const SymmetricPattern *pattern   = nullptr; ///< since attach()
    const FreeDofs         *free_dofs = nullptr; ///< since attach()

  private:
    /// Call visit(gap, blocks) for the second derivatives of barriers and friction.
    void
    visit_blocks(const Vector                                                   &positions,
                 Tangent                                                         kind,
                 const std::function<void(const Gap &, const ContactHessian &)> &visit) const;

    /// What the models of solvers know of friction, of which no barrier is left: where it rubs is not where it is nearest by now.
    Gap
    gap_of(const Rubbing &at, const Vector &positions) const;
  };
} // namespace Exemplar

#endif
