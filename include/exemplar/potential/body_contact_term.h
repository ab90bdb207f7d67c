// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_body_contact_term_h
#define exemplar_body_contact_term_h

#include <exemplar/body/time_integrator.h>
#include <exemplar/potential/body_pair_search.h>
#include <exemplar/potential/contact_forces.h>
#include <exemplar/potential/potential_term.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// A barrier and friction between each pair of parts of the body's surface that are nearer than their width, doc/contact.md, in one process. It
  /// couples nodes that share no cell, in Newton's matrix alone.
  class BodyContactTerm : public PotentialTerm
  {
  public:
    /// `integrator` is null unless the scene is dynamic. All must outlive the term.
    BodyContactTerm(const BodyContacts   &contacts,
                    const ContactSurface &surface,
                    const Material       &material,
                    const TimeIntegrator *integrator);

    std::string
    name() const override
    {
      return "body contact";
    }

    void
    attach(const SymmetricPattern &pattern, const FreeDofs &free_dofs) override;

    void
    follow_parameters() override;

    void
    begin_step(const State &start, double step_size) override;

    TermChange
    renew(const TermPoint &at) override;

    bool
    has_settled() const override
    {
      return step.n_renewals <= max_renewals;
    }

    std::optional<double>
    dissipation(const State &end) const override;

    void
    end_step(const State &end) override;

    void
    leave_step() override;

    double
    gap_width() const override
    {
      return contacts.width;
    }

    NodePairs
    couplings_of_gaps(const Vector &positions) const override;

    void
    append_gaps(const Vector &positions, double range, std::vector<Gap> &gaps) const override;

    void
    append_gaps_of_way(double            now,
                       double            to_time,
                       const Vector     &from,
                       const Vector     &to,
                       double            range,
                       std::vector<Gap> &gaps) override;

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
    max_step(const Vector &positions, const Vector &displacement) const override;

    std::string
    limit_to(double time, const Vector &positions, const Vector &displacement) const override;

    double
    rounding_force(const Vector &positions) const override;

    void
    append_columns(double                                       energy,
                   std::vector<std::pair<std::string, double>> &columns) const override;

    /// Force [N] on the nodes.
    void
    append_fields(const Vector &positions, std::vector<NodalField> &fields) const override;

    NoGradients
    no_gradients() const override
    {
      return { "of bodies that may not pass through themselves or each other",
               "Set Contact/Self and Contact/Bodies = false." };
    }

    void
    save(boost::archive::binary_oarchive &archive) const override;

    void
    load(boost::archive::binary_iarchive &archive) override;

    std::size_t
    memory_consumption() const override;

    /// The pairs that are nearer than `range` times their width.
    std::vector<BodyTouch>
    touches(const Vector &positions, double range = 1.) const;

    static constexpr unsigned int max_renewals  = 20;   ///< a step
    static constexpr double       lag_tolerance = 1e-3; ///< part of the greatest normal force

  private:
    /// What of the term belongs to the step that has begun.
    struct Step
    {
      double               size      = 0.;    ///< [s]
      bool                 has_begun = false; ///< and has not been left
      Vector               slip_base;         ///< x_star of the time scheme [m]
      double               rate = 0.; ///< gamma of the time scheme, or one over the step [1/s]
      std::vector<Rubbing> rubbing;   ///< since the last renewal, ascending
      unsigned int         n_renewals = 0;
    };

    /// How the two points of what rubs have moved along each other in the step [m].
    SpaceVector3
    slip(const Rubbing &at, const Vector &positions) const;

    SlipEnergy
    slip_energy(const Rubbing &at) const
    {
      return { at.coefficient * at.force, contacts.slip_speed / step.rate };
    }

    /// Call visit(gap, gradient) for all barriers and all friction at these positions.
    template <typename Visit>
    void
    visit_gradients(const Vector &positions, const Visit &visit) const;

    /// Call visit(gap, blocks) for their second derivatives.
    template <typename Visit>
    void
    visit_blocks(const Vector &positions, Tangent kind, const Visit &visit) const;

    BodyPairSearch
    search() const
    {
      return { surface, contacts, kept };
    }

    const BodyContacts     &contacts;
    ContactSurface          surface; ///< with the shares of the material
    const Material         &material;
    const TimeIntegrator   *integrator;
    Step                    step;
    mutable KeptBodyPairs   kept;                ///< no result depends on it
    double                  barrier_energy = 0.; ///< where a step ended [J]
    double                  least_gap;
    double                  n_pairs      = 0.;      ///< where a step ended
    double                  normal_force = 0.;      ///< of all pairs [N]
    double                  heat         = 0.;      ///< of friction, since the beginning [J]
    const SymmetricPattern *pattern      = nullptr; ///< since attach()
    const FreeDofs         *free_dofs    = nullptr; ///< since attach()
  };
} // namespace Exemplar

#endif
