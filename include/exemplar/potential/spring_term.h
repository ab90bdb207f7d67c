// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_spring_term_h
#define exemplar_spring_term_h

#include <exemplar/potential/potential_term.h>

#include <deal.II/base/point.h>

#include <array>
#include <map>

namespace Exemplar
{
  /// A spring of no length at rest from a point of a triangle of three nodes, which share a cell, to a
  /// place.
  struct Spring
  {
    std::array<unsigned int, 3> nodes;
    std::array<double, 3>       shares;    ///< of the nodes: barycentric coordinates
    dealii::Point<3>            anchor;    ///< the place [m]
    double                      stiffness; ///< [N/m]
  };

  /// Springs by their names.
  using Springs = std::map<std::string, Spring>;

  /// k/2 |p - a|^2 of each spring, where p is its point of the body and a its anchor. Its tangent couples
  /// only nodes that share a cell, so that springs come and go on the same pattern.
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
    attach(const SymmetricPattern &pattern, const FreeDofs &free_dofs, CellField &cells) override;

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

    std::size_t
    memory_consumption() const override;

  private:
    const std::shared_ptr<const Springs> springs;
    const SymmetricPattern              *pattern   = nullptr; ///< since attach()
    const FreeDofs                      *free_dofs = nullptr; ///< since attach()
  };
} // namespace Exemplar

#endif
