// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_elastic_potential_h
#define exemplar_elastic_potential_h

#include <exemplar/body/example_weights.h>
#include <exemplar/body/laws_of_cells.h>
#include <exemplar/potential/cell_scatter.h>
#include <exemplar/potential/evaluation.h>
#include <exemplar/potential/patch_dilatation.h>

#include <array>
#include <memory>
#include <vector>

namespace Exemplar
{
  /// What frames show of a cell: means over its quadrature points, and the least det F.
  struct CellResults
  {
    std::vector<double> strain_energy_density; ///< 1/2 e:C:e of the elastic strain [J/m^3]
    std::vector<double> det_F;
    std::vector<double> von_mises_stress; ///< of the corotated stress C:(e - eta E(w)) [Pa]
    std::vector<double> plastic_strain
        = {}; ///< the equivalent one [-]; empty unless cells may yield
  };

  /// What the cells of a body are: their laws, geometry and material, and the examples, which may be
  /// none. All must outlive whoever holds this.
  struct ElasticParts
  {
    LawsOfCells         laws;
    const FESpace      &fe_space;
    const Material     &material;      ///< of the body
    const Material     &cell_material; ///< of the cells' own energies, beside those of patches
    const Patches      &patches;       ///< none: cells have their own volume energies
    const ExamplePoses &examples;
    ExampleWeights     &weights;
    const FreeDofs     &free_dofs;
    unsigned int        n_threads = 1; ///< of the loops; no result depends on it
  };

  /// What the rounding of positions makes of the forces and stresses of the cells.
  struct CellRounding
  {
    double force       = 0.; ///< greatest of a node [N]
    double stress_norm = 0.; ///< (sum V T^2)^(1/2)
  };

  /// Psi(x, w), Eqs. (5) and (16), with the stiffness damping: sums over the cells and patches of the body of
  /// energies and forces, the matrix A and the columns G of Eq. (10). Rotations are kept ("frozen") until
  /// update_rotations() or an evaluation that updates them. Positions, displacements and forces are
  /// by degree of freedom.
  class ElasticPotential
  {
  public:
    /// `pattern`, with the couplings() of the parts unless products are apart, must outlive the potential.
    ElasticPotential(const ElasticParts &parts, const SymmetricPattern &pattern);

    /// Pairs of nodes that its tangent couples beside those that share a cell; `in_parts`: but those of outer products.
    static NodePairs
    couplings(const ElasticParts &parts, bool in_parts);

    /// The pattern, or what is held, is another from now on.
    void
    follow_pattern();

    /// Whether its tangent has outer products, which a pattern may be without.
    bool
    couples_by_products() const
    {
      return patches != nullptr && PatchDilatation::couples_by_products(parts.fe_space);
    }

    /// A step begins with this damping, as StrainDamping::set() has it.
    void
    begin_step(double s, const std::vector<WeightedPositions> &history);

    /// From now on states are evaluated without a step that leads to them.
    void
    leave_step();

    CellField &
    get_field()
    {
      return cells;
    }

    const CellField &
    get_field() const
    {
      return cells;
    }

    /// The material, the importance of the examples or the weights' form are others from now on.
    void
    follow_parameters();

    /// Energies and their derivatives. If the caller has the weight_linear_term() of these
    /// positions, the derivatives by the weights are H w - c, and the loop need not sum them.
    void
    evaluate(const Vector              &positions,
             const std::vector<double> &weights,
             ElasticEvaluation         &evaluation,
             RotationUse                rotations   = RotationUse::keep,
             const std::vector<double> *linear_term = nullptr);

    /// Add what the cells of this process give to A, Eq. (8) or (18), to the values on the pattern
    /// [N/m], and to `products` where the pattern wants them apart, and, with weights to find, set what they give to the coupling G, Eqs. (9) and (40): a column a
    /// strained weight on FreeDofs::local_list(), one after the other [N]. An exact tangent needs the rotations of these positions.
    void
    assemble_tangent(Tangent                    tangent,
                     const Vector              &positions,
                     const std::vector<double> &weights,
                     std::vector<double>       &matrix_values,
                     std::vector<double>       &columns,
                     OuterProducts             *products = nullptr);

    /// Add what `displacement` [m] from `positions`, zero but on held degrees of freedom, changes
    /// by that tangent in the forces and the weight gradient. Only cells beside held nodes feel it.
    void
    add_response(Tangent                    tangent,
                 const Vector              &displacement,
                 const Vector              &positions,
                 const std::vector<double> &weights,
                 ElasticEvaluation         &evaluation);

    /// c_i with dPsi/dw = H w - c at these positions [J].
    std::vector<double>
    weight_linear_term(const Vector &positions, RotationUse rotations = RotationUse::keep);

    /// A residual force [N] that is nothing but the rounding of the positions.
    double
    rounding_force() const
    {
      // both strains that damping compares have rounding of their own, the decomposition's, too
      return (1. + 8. * cells.get_damping().factor()) * rounding.force;
    }

    /// A derivative of the energy by a weight [J] that is nothing but the rounding of the positions.
    double
    rounding_weight_gradient() const;

    CellResults
    cell_results(const Vector &positions, const std::vector<double> &weights);

    /// In bytes, its pattern included.
    std::size_t
    memory_consumption() const;

  private:
    CellTask
    task(const Vector &positions, const std::vector<double> &weights, RotationUse rotations);

    /// Let the patches, if there are any, know the dilatations of the cells and these the pressures at a point. Returns
    /// how loops that follow there find the rotations.
    RotationUse
    find_pressures(const TermPoint &at, RotationUse rotations);

    void
    add_penalty(const std::vector<double> &weights, ElasticEvaluation &result) const;

    /// H w - c.
    void
    set_weight_gradient(const std::vector<double> &weights,
                        const std::vector<double> &linear_term,
                        ElasticEvaluation         &result) const;

    /// Call function(point) for the quadrature points of the cells beside held nodes.
    template <typename Function>
    void
    for_points_beside_held_nodes(const Function &function) const
    {
      const unsigned int n = points_per_cell(parts.fe_space.element());
      for (const unsigned int cell : scatter.cells_beside_held_nodes())
        for (unsigned int point = n * cell; point < n * (cell + 1); ++point)
          function(point);
    }

    /// The loop that adds the tangent of a task's law.
    void
    add_tangent_of_law(const CellTask    &task,
                       const TangentTask &tangent,
                       std::size_t        begin,
                       std::size_t        end) const;

    void
    add_mixed_cells(const CellTask &task, TangentTask tangent, std::vector<double> &values);

    template <Element element>
    void
    assemble_coupling(const CellTask &task, bool convex, std::vector<double> &columns);

    /// The part of the cells of this process.
    void
    add_own_response(Tangent          tangent,
                     const Vector    &displacement,
                     const TermPoint &at,
                     ElasticSums     &sums);

    const ElasticParts                     parts;
    const SymmetricPattern                &pattern;
    CellField                              cells;
    CellScatter                            scatter;
    const std::unique_ptr<PatchDilatation> patches; ///< null without patches
    CellRounding                           rounding;
  };
} // namespace Exemplar

#endif
