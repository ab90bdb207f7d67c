// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/mass.h>

#include "body.h"
#include "matrices.h"

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    TEST(FESpace, TakesTheMeshAsItIs)
    {
      const Body body;
      EXPECT_NEAR(body.fe_space.total_volume(), 4., 1e-13);
      for (unsigned int cell = 0; cell < body.fe_space.n_cells(); ++cell)
      {
        const Matrix3<double> F
            = body.fe_space.deformation_gradient(cell, body.fe_space.rest_positions());
        EXPECT_LT(max_difference(F, identity_matrix<double>()), 1e-13);
      }
    }

    TEST(FESpace, MassMatrixIsExact)
    {
      // rho V / 20 (1 + delta_ab) in each tetrahedron
      const Body                 body;
      const Mass                 mass(body.fe_space, body.material, MassMatrix::consistent);
      dealii::FullMatrix<double> expected(body.fe_space.n_nodes(), body.fe_space.n_nodes());
      for (unsigned int cell = 0; cell < body.fe_space.n_cells(); ++cell)
        for (const unsigned int a : body.fe_space.nodes(cell))
          for (const unsigned int b : body.fe_space.nodes(cell))
            expected(a, b) += 1000. * body.fe_space.volume(cell) / 20. * (a == b ? 2. : 1.);
      for (unsigned int a = 0; a < expected.m(); ++a)
        for (unsigned int b = 0; b < expected.m(); ++b)
          EXPECT_NEAR(mass.nodal().el(a, b), expected(a, b), 1e-12);
    }

    // Nodes are the vertices and then the middles of the edges 01, 12, 20, 03, 13, 23; the
    // integrals are a! b! c! d! 3! V / (a + b + c + d + 3)! of monomials of the barycentric
    // coordinates.
    TEST(FESpace, QuadraticMassMatrixIsExact)
    {
      const double V = 1. / 6., rho = 1000.;
      const Mesh   mesh(make_msh({ { 0., 0., 0. }, { 1., 0., 0. }, { 0., 1., 0. }, { 0., 0., 1. } },
                                 { { { 0, 1, 2, 3 } } }),
                        "tetrahedron");
      const FESpace  fe_space(mesh, Element::P2);
      const Material material(MaterialParameters(), mesh.get_material_ids());
      const Mass     mass(fe_space, material, MassMatrix::consistent);
      const auto     entry = [&](const unsigned int a, const unsigned int b)
      {
        const auto nodes = fe_space.nodes(0);
        return mass.nodal().el(nodes[a], nodes[b]) * 420. / (rho * V);
      };
      ASSERT_EQ(fe_space.n_nodes(), 10u);
      EXPECT_NEAR(entry(0, 0), 6., 1e-10);
      EXPECT_NEAR(entry(0, 1), 1., 1e-10);
      EXPECT_NEAR(entry(4, 4), 32., 1e-10);
      EXPECT_NEAR(entry(4, 5), 16., 1e-10); // edges with a common vertex
      EXPECT_NEAR(entry(4, 9), 8., 1e-10);  // and without
      EXPECT_NEAR(entry(0, 4), -4., 1e-10);
      EXPECT_NEAR(entry(0, 9), -6., 1e-10);
      double total = 0.;
      for (unsigned int a = 0; a < 10; ++a)
        for (unsigned int b = 0; b < 10; ++b)
          total += entry(a, b);
      EXPECT_NEAR(total, 420., 1e-9);
      const Mass lumped(fe_space, material, MassMatrix::lumped);
      EXPECT_NEAR(lumped.nodal().el(0, 0), rho * V * 6. / 216., 1e-10);
      EXPECT_NEAR(lumped.nodal().el(9, 9), rho * V * 32. / 216., 1e-10);
    }

    // A quadratic field: its gradient is known everywhere, and four points integrate products of
    // two gradients exactly.
    TEST(FESpace, QuadraticElementsDifferentiateQuadraticFieldsExactly)
    {
      const Body             body(box_mesh(2., 2, 2), MaterialParameters(), Element::P2);
      const FESpace         &space     = body.fe_space;
      dealii::Vector<double> positions = space.rest_positions();
      const auto             field
          = [](const dealii::Point<3> &X) { return X[0] * X[0] - 3. * X[1] * X[2] + 2. * X[2]; };
      for (unsigned int node = 0; node < space.n_nodes(); ++node)
        positions[3 * node] = field(space.rest_position(node));
      double integral = 0.; // of (dx/dX)^2 = 4 X^2
      for (unsigned int point = 0; point < space.n_points(); ++point)
      {
        const double by_x = space.deformation_gradient(point, positions)[0][0];
        integral += space.volume(point) * by_x * by_x;
      }
      EXPECT_NEAR(integral, 4. * 8. / 3., 1e-11);
      EXPECT_NEAR(space.total_volume(), 2., 1e-13);
    }

    TEST(FESpace, MiddlesBelongToSelectionsOfBothEnds)
    {
      const Body                      body(box_mesh(1., 1, 1), MaterialParameters(), Element::P2);
      const std::vector<unsigned int> nodes = body.fe_space.numbering().with_middles({ 0, 1, 3 });
      for (const unsigned int node : nodes)
        if (node >= body.mesh.n_nodes())
        {
          const auto [a, b] = body.fe_space.numbering().ends(node);
          EXPECT_TRUE(a == 0 || a == 1);
          EXPECT_TRUE(b == 1 || b == 3);
        }
      EXPECT_EQ(nodes.size(), 6u); // the box's nodes 0, 1 and 3 are a face of a cell
      const FESpace linear(body.mesh);
      EXPECT_EQ(linear.numbering().with_middles({ 0, 1, 3 }).size(), 3u);
    }

    TEST(FESpace, LumpedMassIsTheRowSum)
    {
      const Body body;
      const Mass mass(body.fe_space, body.material, MassMatrix::lumped);
      double     total = 0.;
      for (unsigned int a = 0; a < body.fe_space.n_nodes(); ++a)
        for (unsigned int b = 0; b < body.fe_space.n_nodes(); ++b)
        {
          total += mass.nodal().el(a, b);
          EXPECT_TRUE(a == b || mass.nodal().el(a, b) == 0.);
        }
      EXPECT_NEAR(total, 4000., 1e-9);
    }
  } // namespace
} // namespace Exemplar::Testing
