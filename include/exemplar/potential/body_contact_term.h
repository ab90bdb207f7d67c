// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_body_contact_term_h
#define exemplar_body_contact_term_h

#include <exemplar/potential/body_pair_search.h>
#include <exemplar/potential/contact_slopes.h>
#include <exemplar/potential/pair_slip.h>
#include <exemplar/potential/touching_term.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  /// A barrier and friction between each pair of parts of the body's surface that are nearer than their width, doc/contact.md, in one process. It
  /// couples nodes that share no cell, in Newton's matrix alone.
  class BodyContactTerm : public TouchingTerm
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
    follow_parameters() override;

    bool
    has_tangent_of_step() const override
    {
      return contacts.friction != 0.;
    }

    void
    begin_step(const State &start, double step_size) override;

    TermChange
    renew(const TermPoint &at) override;

    std::optional<double>
    dissipation(const State &end) const override;

    std::optional<EnergyFlow>
    energy_flow(const State & /*start*/, const State &end) const override
    {
      return EnergyFlow{ true, energy_of_friction(end.positions), 0., 0. };
    }

    void
    end_step(const State &end) override;

    void
    leave_step() override;

    void
    set_time(double /*time*/) override
    {
      step.restart();
    }

    double
    gap_width() const override
    {
      return contacts.width;
    }

    NodePairs
    couplings_of_gaps(const Vector &positions) const override;

    void
    append_gaps_along(const Vector     &positions,
                      const Vector     &displacement,
                      double            reach,
                      std::vector<Gap> &gaps) const override;

    void
    append_gaps_of_way(double            now,
                       double            to_time,
                       const Vector     &from,
                       const Vector     &to,
                       double            range,
                       std::vector<Gap> &gaps) override;

    double
    max_step(const Vector &positions, const Vector &displacement) const override;

    std::string
    limit_to(double time, const Vector &positions, const Vector &displacement) const override;

    void
    append_columns(double                                       energy,
                   std::vector<std::pair<std::string, double>> &columns) const override;

    /// Force [N] on the nodes.
    void
    append_fields(const Vector &positions, std::vector<NodalField> &fields) const override;

    NoGradients
    no_gradients() const override;

    TouchingSlopes
    slopes(const Vector &positions, const Vector &along, const FESpace &fe_space) const override;

    void
    save(boost::archive::binary_oarchive &archive) const override;

    void
    load(boost::archive::binary_iarchive &archive) override;

    std::size_t
    memory_consumption() const override;

    /// The pairs that are nearer than `range` times their width.
    std::vector<BodyTouch>
    touches(const Vector &positions, double range = 1.) const;

    static constexpr double lag_tolerance = 1e-3; ///< part of the greatest normal force

  private:
    void
    visit_touches(const Vector &positions, double range, const VisitTouch &visit) const override
    {
      visit_pairs(positions, range, visit);
    }

    /// Call visit(touch) for the pairs nearer than `range` times their width, in the order of their keys.
    template <typename Visit>
    void
    visit_pairs(const Vector &positions, double range, const Visit &visit) const;

    /// Add what a stiffness, and the part of almost parallel edges, have of the surface at rest.
    void
    add_origins(const BodyTouch &touch, const ContactSlope &slope, ShareDerivatives &by) const;

    /// Pairs that were found last, which are asked for again and again at the same place.
    struct Found
    {
      Vector                 positions; ///< empty: none
      double                 range = 0.;
      std::vector<BodyTouch> touches;
    };

    const RubbingStep &
    rubbing_step() const override
    {
      return step;
    }

    SpaceVector3
    motion_along(const Rubbing &at, const Vector &positions) const override;

    Slip
    slip(const Rubbing &at, const Vector &positions) const override;

    /// slip_of_pair() of the points of a gap.
    std::vector<dealii::Tensor<2, 3>>
    slip_by_points(const Gap &gap, const Vector &positions) const;

    double
    slip_speed(const Rubbing &at) const override
    {
      const auto &nodes = at.gap.nodes; // of both sides
      return std::min(contacts.slip_speeds.at(nodes[0]), contacts.slip_speeds.at(nodes[3]));
    }

    BodyPairSearch
    search() const
    {
      return { surface, contacts, kept };
    }

    const BodyContacts   &contacts;
    RubbingStep           step;
    mutable KeptBodyPairs kept;      ///< no result depends on it
    mutable Found         found;     ///< nor on it
    Reached               reached;   ///< where a step ended
    double                heat = 0.; ///< of friction, since the beginning [J]
  };
} // namespace Exemplar

#endif
