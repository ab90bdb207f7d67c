// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_tie_term_h
#define exemplar_tie_term_h

#include <exemplar/obstacles/ties.h>
#include <exemplar/potential/potential_term.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// k/2 |x - sum_j s_j x_j|^2 of each tie between a node x and the point of a cell with shares s_j of its nodes x_j, with k
  /// the stiffness times the area at the node, or of rigid ties 1e4 E sqrt(area) with the softer side's E. It is quadratic:
  /// its tangent is constant.
  class TieTerm : public PotentialTerm
  {
  public:
    /// All must outlive the term.
    TieTerm(const Ties &ties, const Material &material);

    std::string
    name() const override
    {
      return "ties";
    }

    NodePairs
    couplings() const override;

    void
    attach(const SymmetricPattern &pattern, const FreeDofs &free_dofs) override;

    void
    follow_parameters() override;

    void
    end_step(const State &end) override;

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

    /// Energy of all [J], and of each subsection the force [N] on the nodes of Select where a step has ended.
    void
    append_columns(double                                       energy,
                   std::vector<std::pair<std::string, double>> &columns) const override;

    /// Force [N] on the nodes.
    void
    append_fields(const Vector &positions, std::vector<NodalField> &fields) const override;

    std::optional<EnergyFlow>
    energy_flow(const State & /*start*/, const State & /*end*/) const override
    {
      return EnergyFlow();
    }

    NoGradients
    no_gradients() const override
    {
      return { "of bodies that are tied", "Leave Ties/Names empty." };
    }

    void
    save(boost::archive::binary_oarchive &archive) const override;

    void
    load(boost::archive::binary_iarchive &archive) override;

    std::size_t
    memory_consumption() const override;

  private:
    /// Call visit(tie, k) for each tie and its stiffness [N/m].
    template <typename Visit>
    void
    visit_ties(const Visit &visit) const;

    /// From where a tie's node belongs to where it is [m].
    static dealii::Tensor<1, 3>
    stretch(const Tie &tie, const Vector &positions);

    const Ties                        &ties;
    const Material                    &material;
    std::vector<std::vector<double>>   stiffness; ///< of each tie of each group [N/m]
    std::vector<std::array<double, 3>> forces;    ///< of each group, where a step has ended [N]
    const SymmetricPattern            *pattern   = nullptr; ///< since attach()
    const FreeDofs                    *free_dofs = nullptr; ///< since attach()
  };
} // namespace Exemplar

#endif
