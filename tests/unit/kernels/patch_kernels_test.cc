// SPDX-License-Identifier: GPL-3.0-or-later
#include "body.h"
#include "compared_kernels.h"

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    /// What the loops of patches make of a bar with thin cells, in which the cells at one end are of
    /// strongly stretched patches.
    struct PatchLoops
    {
      PatchLoops(const CellKernels &kernels, const Element element)
      {
        const Body body(box_mesh(4., 3, 1), MaterialParameters(), element); // no whole batches
        const LawsOfCells law(CellLaw::corotational);
        CellBatches       batches(body.fe_space, body.material.without_dilatation(), law,
                                  ExampleConstants());
        const Vector      x       = body.drawn(4., 0.15, 3);
        const std::size_t n       = body.fe_space.n_points();
        const std::size_t n_nodes = body.fe_space.n_nodes();
        dealii::AlignedVector<double> positions(4 * n_nodes);
        for (unsigned int dof = 0; dof < x.size(); ++dof)
          positions[dof / 3 * 4 + dof % 3] = x[dof];
        DilatationField field;
        field.resize(n);
        field.stretch.reinit(n);
        field.stretch.acts = true;
        for (std::size_t point = 0; point < n; ++point)
        {
          field.pressures[point] = 1e5 * (1. + 0.01 * static_cast<double>(point));
          field.scales[point]    = 2e5;
          if (point > 2 * n / 3)
            continue;
          field.stretch.transitions[point]                   = 0.5;
          field.stretch.by_F[point]                          = 1e4;
          field.stretch.stiffnesses[point]                   = 1e6;
          field.stretch.elasticity[batch_index(point, 2, 0)] = 4e6;
          field.stretch.elasticity[batch_index(point, 2, 1)] = 3e5;
        }
        CellTask task;
        task.cells                  = batches.arrays();
        task.dilatation             = field.arrays();
        task.positions              = positions.data();
        task.rotation_use           = RotationUse::update;
        const std::size_t n_batches = task.cells.n_batches();
        kernels.dilatations(task, 0, n_batches);
        EXPECT_TRUE(field.has(thin_cells));
        kernels.stretch_energies(task, 0, n_batches);
        nodal_sums.resize(4 * n_nodes);
        CellSums sums;
        task.rotation_use = RotationUse::keep;
        kernels.evaluate(task, 0, n_batches, nodal_sums.data(), nullptr, sums);
        traces.assign(field.traces.data(), field.traces.data() + n);
        energies.assign(field.stretch.energies.data(), field.stretch.energies.data() + n);

        std::vector<int> to(n_block_columns(nodes_per_cell(element)) * body.fe_space.n_cells());
        for (std::size_t i = 0; i < to.size(); ++i)
          to[i] = static_cast<int>(3 * i); // each cell's matrix by itself
        for (std::vector<double> *matrix : { &exact, &convex })
          matrix->assign(3 * to.size() + SymmetricPattern::padding, 0.);
        kernels.add_patch_tangent(task, { false, to.data(), exact.data() }, 0, n_batches);
        kernels.add_patch_tangent(task, { true, to.data(), convex.data() }, 0, n_batches);
      }

      std::vector<double>           traces, energies, exact, convex;
      dealii::AlignedVector<double> nodal_sums;
    };

    template <typename Numbers>
    double
    relative_difference(const Numbers &a, const Numbers &b)
    {
      double maximum = 0., scale = 0.;
      for (std::size_t i = 0; i < a.size(); ++i)
      {
        maximum = std::max(maximum, std::abs(a[i] - b[i]));
        scale   = std::max(scale, std::abs(a[i]));
      }
      EXPECT_GT(scale, 0.);
      return maximum / scale;
    }

    TEST(PatchKernels, AllInstructionSetsGiveTheSame)
    {
      for (const Element element : { Element::P1, Element::P2 })
      {
        const auto       kernels = scalar_and_all_kernels(element);
        const PatchLoops scalar(*kernels.front(), element);
        for (const CellKernels *set : kernels)
        {
          SCOPED_TRACE(set->name);
          const PatchLoops loops(*set, element);
          EXPECT_LT(relative_difference(loops.traces, scalar.traces), 1e-13);
          EXPECT_LT(relative_difference(loops.energies, scalar.energies), 1e-11);
          EXPECT_LT(relative_difference(loops.nodal_sums, scalar.nodal_sums), 1e-11);
          EXPECT_LT(relative_difference(loops.exact, scalar.exact), 1e-10);
          EXPECT_LT(relative_difference(loops.convex, scalar.convex), 1e-11);
        }
      }
    }

    TEST(PatchKernels, AProductWithNodesIsThatOfTheMatrix)
    {
      // 2 1 0; 1 3 1; 0 1 4
      const std::vector<std::size_t>  starts  = { 0, 2, 4, 5 };
      const std::vector<unsigned int> columns = { 0, 1, 1, 2, 2 };
      const std::vector<double>       values  = { 2., 1., 3., 1., 4. };
      const std::vector<double> x = { 1., 2., 3., 0., 10., 20., 30., 0., 100., 200., 300., 0. };
      for (const CellKernels *kernels : scalar_and_all_kernels(Element::P1))
      {
        std::vector<double> product(12, 0.);
        kernels->multiply_nodes({ starts.data(), columns.data(), values.data() }, 3, x.data(),
                                product.data());
        EXPECT_EQ(product, (std::vector<double>{ 12., 24., 36., 0., 131., 262., 393., 0., 410.,
                                                 820., 1230., 0. }));
      }
    }

    TEST(FibreKernels, FibresPullByTheirAmountsAndLessBelowTheLeastStretch)
    {
      constexpr std::size_t     n       = 11; // whole registers and a rest
      const std::vector<double> amounts = { 2., 1., 0., 3., 1., 4., 2., 2., 5., 1., 2. };
      for (const CellKernels *kernels : scalar_and_all_kernels(Element::P1))
      {
        std::vector<double> vectors(4 * n, 7.);
        double              energy = 0.;
        for (std::size_t i = 0; i < n; ++i)
        {
          const double stretch = i == 3 ? 0.05 : i == 4 ? 0. : 0.3 * (1. + i);
          vectors[4 * i]       = 2. / 3. * stretch;
          vectors[4 * i + 1]   = -2. / 3. * stretch;
          vectors[4 * i + 2]   = 1. / 3. * stretch;
          energy += amounts[i]
                    * (stretch < 0.1 ? -0.9 - 5. * (0.01 - stretch * stretch) : stretch - 1.);
        }
        EXPECT_NEAR(kernels->pull_fibres(amounts.data(), n, 0.1, vectors.data()), energy, 1e-14);
        for (std::size_t i = 0; i < n; ++i)
        {
          const double force = amounts[i] * (i == 3 ? 0.5 : i == 4 ? 0. : 1.);
          EXPECT_NEAR(vectors[4 * i], 2. / 3. * force, 1e-15);
          EXPECT_NEAR(vectors[4 * i + 1], -2. / 3. * force, 1e-15);
          EXPECT_NEAR(vectors[4 * i + 2], 1. / 3. * force, 1e-15);
          EXPECT_NEAR(vectors[4 * i + 3], force, 1e-15);
        }
      }
    }

    TEST(FibreKernels, VectorsAndForcesOfFibresAreSumsOverTheNodesOfACell)
    {
      const std::vector<unsigned int> nodes  = { 0, 2, 3, 1 };
      const std::vector<double>       shares = { 1., -2., 0.5, 0.5 };
      const std::vector<double>       x
          = { 1., 2., 3., 0., 4., 4., 8., 0., 1., 1., 0., 0., 2., 6., 4., 0. };
      const std::vector<double> force = { 2., 4., -6., 8. };
      for (const CellKernels *kernels : scalar_and_all_kernels(Element::P1))
      {
        const FibreArrays   fibres{ nodes.data(), shares.data() };
        std::vector<double> vector(4), sums(16, 1.);
        kernels->fibre_vectors(fibres, 0, 1, x.data(), vector.data());
        vector[3] = 0.;
        EXPECT_EQ(vector, (std::vector<double>{ 2., 5., 9., 0. }));
        kernels->add_fibre_forces(fibres, 0, 1, force.data(), sums.data());
        EXPECT_EQ(sums, (std::vector<double>{ 3., 5., -5., 9., 2., 3., -2., 5., -3., -7., 13., 17.,
                                              2., 3., -2., 5. }));
      }
    }
  } // namespace
} // namespace Exemplar::Testing
