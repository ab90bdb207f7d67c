// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_weak_springs_h
#define exemplar_weak_springs_h

#include <exemplar/body/fe_space.h>
#include <exemplar/potential/obstacle_term.h>

namespace Exemplar
{
  /// Springs between the surface of a static body and anchors. They constrain the rigid motions that neither handles nor
  /// obstacles constrain, doc/contact.md, with k = factor E L in all (mean stiffness E, size L), in shares of the surface.
  /// Barriers stay out of inverses that are kept for a step, these springs do not: without them such a matrix is singular.
  class WeakSprings : public PotentialTerm
  {
  public:
    /// With FreeBodies::weak_springs the anchors are the places at rest. With
    /// FreeBodies::friction they follow the body, so that the friction of `obstacles`, which must come before this term
    /// in the potential, bears the load alone. `size` is L in m. All must outlive the term.
    WeakSprings(FreeBodies            kind,
                double                size,
                const ContactSurface &surface,
                const Material       &material,
                const FESpace        &fe_space,
                const ObstacleTerm   &obstacles);

    std::string
    name() const override
    {
      return "weak springs";
    }

    void
    attach(const SymmetricPattern &new_pattern, const FreeDofs &new_free_dofs) override
    {
      pattern   = &new_pattern;
      free_dofs = &new_free_dofs;
    }

    void
    follow_parameters() override
    {
      surface.set_material(material);
    }

    void
    begin_step(const State &start, double step_size) override;

    TermChange
    renew(const TermPoint &at) override;

    bool
    has_settled() const override
    {
      return n_renewals <= max_renewals;
    }

    std::vector<unsigned int>
    weakly_constrained_pieces() const override
    {
      return pieces;
    }

    bool
    has_tangent_of_step() const override
    {
      return kind == FreeBodies::friction;
    }

    void
    end_step(const State &end) override;

    void
    leave_step() override
    {
      in_step = false;
    }

    void
    add(const TermPoint &at, ElasticSums &sums) override;

    void
    add_tangent(const TermPoint     &at,
                Tangent              kind,
                std::vector<double> &values,
                std::vector<double> &columns) override;

    /// Springs that hold until friction does lose their energy, because the next step has other anchors.
    std::optional<EnergyFlow>
    energy_flow(const State &start, const State &end) const override;

    void
    add_response(const TermPoint &at,
                 Tangent          kind,
                 const Vector    &displacement,
                 ElasticSums     &sums) override;

    void
    append_columns(double                                       energy,
                   std::vector<std::pair<std::string, double>> &columns) const override;

    NoGradients
    no_gradients() const override
    {
      return {};
    }

    void
    save(boost::archive::binary_oarchive &archive) const override;

    void
    load(boost::archive::binary_iarchive &archive) override;

    std::size_t
    memory_consumption() const override
    {
      return surface.memory_consumption() + anchors.memory_consumption();
    }

  private:
    /// Of a node, now [N/m].
    double
    stiffness(const ContactSurface::Node &node) const;

    /// The same of a tangent. A convex one is stiffer: otherwise its inverse on rigid motions would be a million times that on
    /// strains, beyond single precision and what conjugate gradients bear.
    double
    stiffness(const ContactSurface::Node &node, Tangent tangent) const;

    /// Of the spring at a node [m].
    SpaceVector3
    stretch(const ContactSurface::Node &node, const Vector &positions) const;

    /// The greatest force of a spring, of all processes [N].
    double
    greatest_force(const Vector &positions) const;

    static constexpr unsigned int max_renewals = 20; ///< of the anchors in a step

    const FreeBodies                kind;
    const double                    size;
    ContactSurface                  surface; ///< with the shares of the material
    const Material                 &material;
    const ObstacleTerm             &obstacles;
    const std::vector<unsigned int> pieces;       ///< of the nodes
    double                          by_area = 0.; ///< E L / surface [N/m^3]
    Vector                          anchors;
    bool                            in_step = false;
    bool   has_let_go = false; ///< stiffer springs need not hold the body now until friction does
    Vector held_at;            ///< anchors of the stiffer ones
    unsigned int            n_looks = 0; ///< of the obstacles in the step, as of the last renew()
    unsigned int            n_renewals = 0; ///< of the anchors in the step
    SpaceVector3            force;          ///< on the body where a step ended, of this process [N]
    const SymmetricPattern *pattern   = nullptr; ///< since attach()
    const FreeDofs         *free_dofs = nullptr; ///< since attach()
  };
} // namespace Exemplar

#endif
