// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/cell_batches.h>

#include "body.h"
#include "compared_kernels.h"
#include "matrices.h"

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    /// Stretches all cells so that they reach the guard, but for the first, which collapses.
    void
    pull(dealii::Vector<double> &x, const FESpace &fe_space)
    {
      for (unsigned int dof = 0; dof < x.size(); ++dof)
        x[dof] *= dof % 3 == 0 ? 10. : 0.1;
      for (const unsigned int node : fe_space.nodes(0))
        for (unsigned int c = 0; c < 3; ++c)
          x[3 * node + c] = 0.3;
    }

    /// What the loops over the cells of a body find, by one set of kernels.
    struct Loops
    {
      Loops(const CellKernels &kernels,
            const Element      element,
            const CellLaw      law,
            const bool         per_region,
            const bool         is_pulled)
      {
        // 18 cells are no whole number of batches
        const Body        body(bar_of_two_regions(2., box_mesh(4., 3, 1)), element);
        ExampleParameters parameters;
        parameters.pose_functions     = twist(60.) + " | 1.1*x; 0.9*y; z";
        parameters.importance         = 0.7;
        parameters.weights_per_region = per_region;
        const auto  examples          = body.examples(parameters);
        CellBatches batches(body.fe_space, body.material, law, ExampleConstants());
        batches.set_step_size(0.5);
        std::mt19937 generator(5);
        auto         x = body.random_positions(generator, 0.8); // some cells invert
        if (is_pulled)
          pull(x, body.fe_space);
        const std::size_t             n       = body.fe_space.n_points();
        const std::size_t             n_nodes = body.fe_space.n_nodes();
        dealii::AlignedVector<double> positions(4 * n_nodes);
        for (unsigned int dof = 0; dof < x.size(); ++dof)
          positions[dof / 3 * 4 + dof % 3] = x[dof];
        dealii::AlignedVector<double> damping(batched_size(n, 1), 0.3);
        dealii::AlignedVector<double> past(batched_size(n, 6), 0.01);
        const std::vector<double>     weights(examples->n_weights(), 0.4);

        CellTask task;
        task.cells                  = batches.arrays();
        task.examples               = examples->get_strains().arrays();
        task.damping                = { damping.data(), past.data() };
        task.positions              = positions.data();
        task.weights                = weights.data();
        task.rotation_use           = RotationUse::update;
        task.with_weight_sums       = true;
        const std::size_t n_batches = task.cells.n_batches();

        nodal_sums.resize(4 * n_nodes);
        weight_sums.resize(batch_size * weights.size());
        kernels.evaluate(task, 0, n_batches, nodal_sums.data(), weight_sums.data(), sums);
        weight_linear_term.resize(weight_sums.size());
        kernels.weight_linear_term(task, 0, n_batches, weight_linear_term.data());
        rotations.assign(task.cells.rotations, task.cells.rotations + 9 * n);

        std::vector<int> matrix_positions(n_block_columns(nodes_per_cell(element))
                                          * body.fe_space.n_cells());
        for (std::size_t i = 0; i < matrix_positions.size(); ++i)
          matrix_positions[i] = static_cast<int>(3 * i); // each cell's matrix by itself
        for (const bool is_convex : { false, true })
        {
          std::vector<double> &matrix = is_convex ? convex : exact;
          matrix.assign(3 * matrix_positions.size() + SymmetricPattern::padding, 0.);
          kernels.add_tangent(task, { is_convex, matrix_positions.data(), matrix.data() }, 0,
                              n_batches);
          auto &columns = is_convex ? convex_coupling : coupling;
          columns.resize(3 * nodes_per_cell(element) * batch_size * task.examples.n);
          kernels.coupling(task, is_convex, 1, columns.data());
        }

        dealii::AlignedVector<float> rotation_sums(12 * n_nodes);
        kernels.add_rotations(task, 0, n_batches, rotation_sums.data());
        node_rotations.resize(9 * n_nodes);
        kernels.closest_rotations(n_nodes, rotation_sums.data(), node_rotations.data());
        find_slopes(kernels, task, body.random_positions(generator, 1.));
      }

      void
      find_slopes(const CellKernels &kernels, CellTask task, const dealii::Vector<double> &along)
      {
        task.damping        = {};
        const std::size_t n = batched_size(task.cells.n_cells, 1);
        strains.resize(n_symmetric * n);
        factors.resize(n, 1.);
        kernels.add_strains(task, 0.5, 0, task.cells.n_batches(), strains.data(), factors.data());
        dealii::AlignedVector<double> changes(4 * along.size() / 3), targets(2 * strains.size());
        for (unsigned int dof = 0; dof < along.size(); ++dof)
          changes[dof / 3 * 4 + dof % 3] = along[dof];
        for (std::size_t i = 0; i < targets.size(); ++i)
          targets[i] = 0.1 * std::sin(0.7 * i);
        dealii::AlignedVector<double> pressures(PressureEntry::size * n);
        for (std::size_t i = 0; i < pressures.size(); ++i)
          pressures[i] = 0.2 * std::cos(0.9 * i);
        traces.resize(TraceEntry::size * n);
        works.resize(n);
        // batch by batch, as arrays begin with the first one of a loop
        for (std::size_t begin = 0; begin < task.cells.n_batches(); ++begin)
        {
          kernels.works(task,
                        { changes.data(), &targets[begin * batch_size * 2 * n_symmetric],
                          &works[begin * batch_size],
                          &pressures[begin * batch_size * PressureEntry::size] },
                        begin, begin + 1);
          kernels.traces(
              task, { changes.data(), nullptr, &traces[begin * batch_size * TraceEntry::size] },
              begin, begin + 1);
        }
        if (!law_has_slope(task.cells.law))
          return;
        slopes.resize(SlopeEntry::size * n);
        kernels.slopes(task, { changes.data(), targets.data(), slopes.data(), pressures.data() }, 0,
                       task.cells.n_batches());
        for (std::size_t point = 0; point < n; ++point)
          if (slopes[batch_index(point, SlopeEntry::size, SlopeEntry::is_guarded)] != 0.)
            for (std::size_t k = 0; k < SlopeEntry::is_guarded; ++k)
              slopes[batch_index(point, SlopeEntry::size, k)] = 0.;
      }

      static bool
      law_has_slope(const CellLaw law)
      {
        return law_functions<double>(law).slope != nullptr;
      }

      dealii::AlignedVector<double> strains, factors, works, traces, slopes;

      dealii::AlignedVector<double> nodal_sums, weight_sums, weight_linear_term, coupling,
          convex_coupling;
      std::vector<double> rotations, convex, exact;
      std::vector<float>  node_rotations;
      CellSums            sums;
    };

    template <typename Vector>
    double
    difference(const Vector &a, const Vector &b)
    {
      double maximum = 0., scale = 1e-300;
      EXPECT_EQ(a.size(), b.size());
      for (std::size_t i = 0; i < a.size(); ++i)
      {
        maximum = std::max<double>(maximum, std::abs(a[i] - b[i]));
        scale   = std::max<double>(scale, std::abs(a[i]));
      }
      return maximum / scale;
    }

    class CellKernelsTest : public testing::TestWithParam<std::tuple<Element, CellLaw, bool>>
    {
    };

    TEST_P(CellKernelsTest, AllInstructionSetsAgreeWithTheScalarCode)
    {
      const auto [element, law, per_region] = GetParam();
      const auto  all                       = scalar_and_all_kernels(element);
      const Loops scalar(*all[0], element, law, per_region, false);
      EXPECT_GT(scalar.sums.inverted_cells, 0u); // so that guards act, too
      for (const CellKernels *kernels : all)
      {
        SCOPED_TRACE(kernels->name);
        const Loops  loops(*kernels, element, law, per_region, false);
        const double tolerance = 1e-10; // near ambiguous rotations rounding grows
        EXPECT_NEAR(loops.sums.energy / scalar.sums.energy, 1., 1e-12);
        EXPECT_NEAR(loops.sums.energy_elastic / scalar.sums.energy_elastic, 1., 1e-12);
        EXPECT_NEAR(loops.sums.energy_damping / scalar.sums.energy_damping, 1., 1e-12);
        EXPECT_NEAR(loops.sums.stress_square / scalar.sums.stress_square, 1., 1e-12);
        EXPECT_NEAR(loops.sums.min_det_F, scalar.sums.min_det_F, 1e-12);
        EXPECT_EQ(loops.sums.inverted_cells, scalar.sums.inverted_cells);
        EXPECT_EQ(loops.sums.guarded_cells, scalar.sums.guarded_cells);
        EXPECT_LT(difference(loops.nodal_sums, scalar.nodal_sums), tolerance);
        EXPECT_LT(difference(loops.weight_sums, scalar.weight_sums), 1e3 * tolerance);
        EXPECT_LT(difference(loops.weight_linear_term, scalar.weight_linear_term), tolerance);
        EXPECT_LT(difference(loops.rotations, scalar.rotations), tolerance);
        EXPECT_LT(difference(loops.convex, scalar.convex), tolerance);
        EXPECT_LT(difference(loops.exact, scalar.exact), tolerance);
        EXPECT_LT(difference(loops.coupling, scalar.coupling), tolerance);
        EXPECT_LT(difference(loops.convex_coupling, scalar.convex_coupling), tolerance);
        EXPECT_LT(difference(loops.node_rotations, scalar.node_rotations), 1e-5);
        EXPECT_LT(difference(loops.strains, scalar.strains), tolerance);
        EXPECT_EQ(difference(loops.factors, scalar.factors), 0.);
        EXPECT_LT(difference(loops.works, scalar.works), tolerance);
        EXPECT_LT(difference(loops.traces, scalar.traces), tolerance);
        EXPECT_LT(difference(loops.slopes, scalar.slopes), tolerance);
      }
    }

    // In a cell with F = 0 the ratios of the stretch guard would be 0 / 0. Its rotation is
    // ambiguous, so that forces may differ.
    TEST_P(CellKernelsTest, ACollapsedCellDoesNotSpoilTheStretchGuardBesideIt)
    {
      const auto [element, law, per_region] = GetParam();
      const auto  all                       = scalar_and_all_kernels(element);
      const Loops scalar(*all[0], element, law, per_region, true);
      for (const CellKernels *kernels : all)
      {
        SCOPED_TRACE(kernels->name);
        const Loops loops(*kernels, element, law, per_region, true);
        EXPECT_NEAR(loops.sums.energy / scalar.sums.energy, 1., 1e-12);
        for (const double force : loops.nodal_sums)
          ASSERT_TRUE(std::isfinite(force));
      }
    }

    INSTANTIATE_TEST_SUITE_P(,
                             CellKernelsTest,
                             testing::Combine(testing::Values(Element::P1, Element::P2),
                                              testing::ValuesIn(all_laws()),
                                              testing::Bool()));
  } // namespace
} // namespace Exemplar::Testing
