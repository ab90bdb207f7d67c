// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_initial_stress_term_h
#define exemplar_initial_stress_term_h

#include <exemplar/potential/cell_field.h>
#include <exemplar/potential/cell_scatter.h>
#include <exemplar/potential/potential_term.h>

#include <optional>
#include <vector>

namespace Exemplar
{
  /// Stresses [Pa] of the quadrature points, in the axes of the rest pose.
  using PointStresses = std::vector<Matrix3<double>>;

  /// Stresses tau that the cells carry from the beginning: sum V tau:e with the strain e that the law of a
  /// cell has, freed of its rotation or linear, Eq. (39). Neither examples nor yielding see them.
  class InitialStressTerm : public PotentialTerm
  {
  public:
    /// The stresses at the points of these cells. All must outlive the term.
    InitialStressTerm(CellField &cells, const FESpace &fe_space, const PointStresses &stresses)
        : cells(cells), fe_space(fe_space), stresses(stresses)
    {
    }

    std::string
    name() const override
    {
      return "initial stress";
    }

    void
    attach(const SymmetricPattern &pattern, const FreeDofs &free_dofs) override;

    void
    add(const TermPoint &at, ElasticSums &sums) override;

    /// Nothing in a convex tangent.
    void
    add_tangent(const TermPoint     &at,
                Tangent              kind,
                std::vector<double> &values,
                std::vector<double> &columns) override;

    void
    append_columns(const double                                 energy,
                   std::vector<std::pair<std::string, double>> &columns) const override
    {
      columns.emplace_back("energy_balance", energy);
    }

    std::optional<EnergyFlow>
    energy_flow(const State & /*start*/, const State & /*end*/) const override
    {
      return EnergyFlow();
    }

    NoGradients
    no_gradients() const override
    {
      return { "of balanced bodies, whose initial stresses depend on all that they are made of",
               "Set Loads/Balanced = false." };
    }

    std::size_t
    memory_consumption() const override;

  private:
    /// Whether the strain of a point is freed of its rotation.
    bool
    turns(unsigned int point) const;

    /// Add what couples the nodes of a cell at a point, in the order of CellScatter.
    void
    add_blocks(unsigned int point, const Vector &positions, std::vector<double> &blocks) const;

    CellField                 &cells;
    const FESpace             &fe_space;
    const PointStresses       &stresses;
    std::optional<CellScatter> scatter; ///< since attach()
  };
} // namespace Exemplar

#endif
