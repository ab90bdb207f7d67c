// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_elastic_potential_h
#define exemplar_elastic_potential_h

#include <exemplar/body/example_weights.h>
#include <exemplar/body/laws_of_cells.h>
#include <exemplar/potential/cell_scatter.h>
#include <exemplar/potential/elastic_body.h>
#include <exemplar/potential/patch_dilatation.h>

#include <memory>
#include <optional>
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
    double rest_size   = 0.; ///< the greatest coordinate at rest [m], for which the others are
    double force       = 0.; ///< greatest of a node [N]
    double stress_norm = 0.; ///< (sum V T^2)^(1/2)
  };

  /// What the cells of each stripe sum up for each weight, lane by lane.
  class WeightSums
  {
  public:
    /// Zeros.
    void
    reinit(const std::size_t n_stripes, const std::size_t new_n_weights)
    {
      n_weights = new_n_weights;
      lanes.resize_fast(n_stripes * n_weights * batch_size);
      lanes.fill(0.);
    }

    double *
    of_stripe(const std::size_t stripe)
    {
      return lanes.data() + stripe * n_weights * batch_size;
    }

    /// Overwrite by the sums over stripes and lanes.
    void
    total(std::vector<double> &sums) const
    {
      sums.assign(n_weights, 0.);
      for (std::size_t i = 0; i < lanes.size(); ++i)
        sums[i / batch_size % n_weights] += lanes[i];
    }

  private:
    std::size_t                   n_weights = 0;
    dealii::AlignedVector<double> lanes;
  };

  /// The body of cells and their patches.
  class ElasticPotential : public ElasticBody
  {
  public:
    /// Needs attach() before all else.
    explicit ElasticPotential(const ElasticParts &parts);

    SymmetricPattern
    make_pattern(const NodePairs &more, bool in_parts) const override;

    bool
    couples_by_products() const override
    {
      return parts.patches.size() > 0 && PatchDilatation::couples_by_products(parts.fe_space);
    }

    void
    attach(const SymmetricPattern &pattern) override;

    void
    follow_parameters() override;

    void
    begin_step(double s, const std::vector<WeightedPositions> &past) override;

    void
    leave_step() override;

    void
    set_step_size(const double size) override
    {
      cells.get_batches().set_step_size(size);
    }

    const CellOrder &
    history_order() const override
    {
      return parts.fe_space.cell_order();
    }

    bool
    remembers() const override
    {
      return cells.get_batches().remembers();
    }

    void
    set_history(const std::vector<double> &history) override
    {
      cells.get_batches().set_history(history);
    }

    std::vector<double>
    advance_history(const Vector &positions) override
    {
      return cells.advance_history(positions);
    }

    void
    update_rotations(const Vector &positions) override
    {
      cells.update_rotations(positions);
    }

    void
    node_rotations(std::vector<float> &rotations) override
    {
      cells.node_rotations(rotations);
    }

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

    void
    evaluate(const Vector              &positions,
             const std::vector<double> &weights,
             ElasticEvaluation         &evaluation,
             RotationUse                rotations   = RotationUse::keep,
             const std::vector<double> *linear_term = nullptr) override;

    void
    assemble_tangent(Tangent                    tangent,
                     const Vector              &positions,
                     const std::vector<double> &weights,
                     std::vector<double>       &matrix_values,
                     std::vector<double>       &columns,
                     OuterProducts             *products = nullptr) override;

    void
    add_response(Tangent                    tangent,
                 const Vector              &displacement,
                 const Vector              &positions,
                 const std::vector<double> &weights,
                 ElasticEvaluation         &evaluation) override;

    std::vector<double>
    weight_linear_term(const Vector &positions, RotationUse rotations = RotationUse::keep) override;

    double
    rounding_force(double size) const override;

    double
    rounding_weight_gradient() const override;

    CellResults
    cell_results(const Vector &positions, const std::vector<double> &weights);

    std::size_t
    memory_consumption() const override;

  private:
    CellTask
    task(const Vector &positions, const std::vector<double> &weights, RotationUse rotations);

    /// Let the patches, if there are any, know the dilatations of the cells and these the pressures at a point. Returns
    /// how loops that follow there find the rotations.
    RotationUse
    find_pressures(const TermPoint &at, RotationUse rotations);

    /// Call function(point) for the quadrature points of the cells beside held nodes.
    template <typename Function>
    void
    for_points_beside_held_nodes(const Function &function) const
    {
      const unsigned int n = points_per_cell(parts.fe_space.element());
      for (const unsigned int cell : scatter->cells_beside_held_nodes())
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

    const ElasticParts         parts;
    CellField                  cells;
    const SymmetricPattern    *pattern = nullptr; ///< since attach()
    std::optional<CellScatter> scatter;           ///< since attach()

    /// What has an energy beside the cells' own: the patches, if there are any.
    std::vector<std::unique_ptr<PatchDilatation>> blocks;
    CellRounding                                  rounding;
    std::vector<CellSums>                         stripe_sums; ///< memory of evaluate()
    WeightSums                                    weight_sums; ///< memory, as before
  };
} // namespace Exemplar

#endif
