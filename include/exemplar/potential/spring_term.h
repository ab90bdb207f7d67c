// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_spring_term_h
#define exemplar_spring_term_h

#include <exemplar/potential/potential_term.h>

#include <deal.II/base/point.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace Exemplar
{
  /// What a hand pulls at: nodes, each of which strives to its own place beside the anchor, so that the
  /// pull is spread over the body instead of crushing one triangle.
  struct Spring
  {
    /// A node of it.
    struct End
    {
      unsigned int         node;
      double               share;  ///< of the stiffness
      dealii::Tensor<1, 3> offset; ///< from the anchor to where it strives [m]
    };

    std::vector<End> ends;
    dealii::Point<3> anchor;    ///< [m]
    double           stiffness; ///< of all together [N/m]
  };

  /// Springs by their names.
  using Springs = std::map<std::string, Spring>;

  /// k/2 sum_i s_i |x_i - a - r_i|^2 of each spring, where s_i and r_i are the share and the offset of
  /// node i, and a is the anchor. Its tangent is diagonal, so that springs come and go on the same pattern.
  class SpringTerm : public PotentialTerm
  {
  public:
    /// `springs` may change between steps.
    explicit SpringTerm(std::shared_ptr<const Springs> springs) : springs(std::move(springs)) {}

    std::string
    name() const override
    {
      return "springs";
    }

    void
    attach(const SymmetricPattern &pattern, const FreeDofs &free_dofs) override;

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

    std::optional<EnergyFlow>
    energy_flow(const State & /*start*/, const State & /*end*/) const override
    {
      return EnergyFlow();
    }

    std::size_t
    memory_consumption() const override;

  private:
    const std::shared_ptr<const Springs> springs;
    const SymmetricPattern              *pattern   = nullptr; ///< since attach()
    const FreeDofs                      *free_dofs = nullptr; ///< since attach()
  };
} // namespace Exemplar

#endif
