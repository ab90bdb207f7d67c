// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/elastic_potential.h>
#include <exemplar/potential/stretch_stiffness.h>

#include <algorithm>

// The matrix A and the columns G of a step: R K R^T, for which four vectors are turned and
// no matrix is multiplied, and the tangents of the models.

namespace Exemplar
{
  namespace
  {
    /// What a displacement changes at single quadrature points, by the tangent of a kind at some positions
    /// and weights; it is added to `sums`.
    class PointResponse
    {
    public:
      PointResponse(const ElasticParts &parts,
                    const CellField    &cells,
                    const Tangent       tangent,
                    const TermPoint    &at,
                    ElasticSums        &sums)
          : parts(parts), cells(cells), tangent(tangent), at(at), sums(sums)
      {
      }

      void
      add(const unsigned int point, const Vector &displacement)
      {
        const auto           &law    = law_functions<double>(cells.get_batches().law(point));
        const bool            convex = tangent == Tangent::convex;
        const Matrix3<double> M      = transpose_times(
                 cells.rotation(point), parts.fe_space.deformation_gradient(point, displacement));
        LawInput<double> in
            = cells.law_input(point, parts.fe_space.deformation_gradient(point, at.positions));
        in.target = parts.examples.strain(point, at.weights);
        LawTangent<double> of_point;
        law.tangent(in, convex, of_point);
        add_force(point, of_point.response(M));
        if (sums->weight_gradient.empty())
          return;
        parts.examples.get_strains().for_each_weight(
            point,
            [&](const unsigned int weight, const unsigned int i, const double share)
            {
              const Matrix3<double> E = parts.examples.strain(point, i);
              Matrix3<double>       dP;
              law.columns(in, convex, 1, &E, &dP);
              sums->weight_gradient[weight]
                  -= share * parts.fe_space.volume(point) * contract(dP, M);
            });
      }

    private:
      /// Nodal forces of a change of R^T P.
      void
      add_force(const unsigned int point, const Matrix3<double> &dP)
      {
        const Matrix3<double> P     = cells.rotation(point) * dP;
        const auto            nodes = parts.fe_space.nodes(parts.fe_space.cell_of(point));
        const auto            g     = parts.fe_space.gradients(point);
        for (unsigned int a = 0; a < nodes.size(); ++a)
        {
          const Vector3<double> force = P * g[a];
          for (unsigned int c = 0; c < 3; ++c)
            sums->gradient[3 * nodes[a] + c] += force[c] * parts.fe_space.volume(point);
        }
      }

      const ElasticParts &parts;
      const CellField    &cells;
      const Tangent       tangent;
      const TermPoint    &at;
      ElasticSums        &sums;
    };
  } // namespace

  void
  ElasticPotential::add_tangent_of_law(const CellTask    &task,
                                       const TangentTask &tangent,
                                       const std::size_t  begin,
                                       const std::size_t  end) const
  {
    cells.loops().add_tangent(task, tangent, begin, end);
    if (task.dilatation.traces != nullptr
        && (cells.get_dilatation().stretch.acts || cells.get_dilatation().has(thin_cells)))
      cells.loops().add_patch_tangent(task, tangent, begin, end);
  }

  void
  ElasticPotential::add_mixed_cells(const CellTask      &task,
                                    TangentTask          tangent,
                                    std::vector<double> &values)
  {
    // rows of a block are not consecutive there: the kernel writes whole blocks apart
    const Element     element = parts.fe_space.element();
    const std::size_t n       = n_block_columns(nodes_per_cell(element));
    const std::size_t n_cells = batch_size / points_per_cell(element); // in a batch
    for (const unsigned int cell : scatter->mixed_cells())
    {
      const std::size_t   batch = cell / n_cells;
      std::vector<int>    apart(n * n_cells, FreeDofs::held);
      std::vector<double> blocks(3 * n + SymmetricPattern::padding, 0.);
      for (std::size_t column = 0; column < n; ++column)
        apart[n * (cell % n_cells) + column] = static_cast<int>(3 * column);
      tangent.positions = apart.data();
      tangent.values    = blocks.data();
      cells.for_each_law(task, [&](const CellTask &of_law)
                         { add_tangent_of_law(of_law, tangent, batch, batch + 1); });
      scatter->add_blocks(cell, blocks.data(), values);
    }
  }

  template <Element element>
  void
  ElasticPotential::assemble_coupling(const CellTask      &task,
                                      const bool           convex,
                                      std::vector<double> &columns)
  {
    constexpr std::size_t n_rows   = 3 * nodes_per_cell(element);
    const ExamplePoses   &examples = parts.examples;
    const std::size_t     n = parts.free_dofs.local_list().size(), n_strained = task.examples.n;
    columns.assign(n * examples.n_strained_weights(), 0.);
    dealii::AlignedVector<double> forces(n_rows * batch_size * n_strained);
    int                           dof[n_rows];
    for (unsigned int point = 0; point < parts.fe_space.n_points(); ++point)
    {
      const std::size_t lane = point % batch_size;
      if (lane == 0)
        cells.for_each_law(
            task, [&](const CellTask &of_law)
            { cells.loops().coupling(of_law, convex, point / batch_size, forces.data()); });
      for (unsigned int p = 0; p < n_rows && point % points_per_cell(element) == 0; ++p)
        dof[p] = parts.free_dofs.free_index(3 * cells.node(point, p / 3) + p % 3);
      examples.get_strains().for_each_weight(
          point,
          [&](const unsigned int weight, const unsigned int i, const double share)
          {
            double       *column = columns.data() + n * examples.strained_index(weight);
            const double *force  = &forces[n_rows * batch_size * (i - task.examples.first) + lane];
            for (unsigned int p = 0; p < n_rows; ++p)
              if (dof[p] != FreeDofs::held)
                column[dof[p]] += share * force[p * batch_size];
          });
    }
  }

  void
  ElasticPotential::assemble_tangent(const Tangent              tangent,
                                     const Vector              &positions,
                                     const std::vector<double> &weights,
                                     std::vector<double>       &matrix_values,
                                     std::vector<double>       &columns,
                                     OuterProducts             *products)
  {
    find_pressures({ positions, weights }, RotationUse::keep);
    CellTask cell_task = task(positions, weights, RotationUse::keep);
    if (tangent == Tangent::convex)
      cell_task.damping = cells.get_damping().arrays_of_all_cells();
    const TangentTask to
        = { tangent == Tangent::convex, scatter->positions(), matrix_values.data() };
    cells.for_each_law(cell_task, [&](const CellTask &of_law)
                       { add_tangent_of_law(of_law, to, 0, of_law.cells.n_batches()); });
    add_mixed_cells(cell_task, to, matrix_values);
    if (tangent == Tangent::convex)
      add_stretch_stiffness(parts.fe_space, cells, *scatter, positions, matrix_values);
    columns.clear();
    if (parts.weights.n_unknown() > 0)
      with_element(parts.fe_space.element(),
                   [&](const auto of) { assemble_coupling<of()>(cell_task, to.convex, columns); });
    for (const auto &block : blocks)
      block->add_tangent({ positions, weights }, tangent, matrix_values, columns, products);
  }

  void
  ElasticPotential::add_response(const Tangent              tangent,
                                 const Vector              &displacement,
                                 const Vector              &positions,
                                 const std::vector<double> &weights,
                                 ElasticEvaluation         &result)
  {
    ElasticSums own;
    own->gradient.reinit(positions.size());
    own->weight_gradient.assign(result.weight_gradient.size(), 0.);
    add_own_response(tangent, displacement, { positions, weights }, own);
    const Exchange &exchange = parts.fe_space.exchange();
    exchange.assemble(own->gradient.begin(), 3);
    exchange.sum(own->weight_gradient);
    result.gradient += own->gradient;
    for (std::size_t i = 0; i < result.weight_gradient.size(); ++i)
      result.weight_gradient[i] += own->weight_gradient[i];
  }

  void
  ElasticPotential::add_own_response(const Tangent    tangent,
                                     const Vector    &displacement,
                                     const TermPoint &at,
                                     ElasticSums     &sums)
  {
    find_pressures(at, RotationUse::keep);
    cells.refresh_rotations();
    for (const auto &block : blocks)
      block->add_response(at, tangent, displacement, sums);
    PointResponse response(parts, cells, tangent, at, sums);
    for_points_beside_held_nodes([&](const unsigned int point)
                                 { response.add(point, displacement); });
  }
} // namespace Exemplar
