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
            expected(a, b)
                += 1000. * body.fe_space.tetrahedron(cell).volume / 20. * (a == b ? 2. : 1.);
      for (unsigned int a = 0; a < expected.m(); ++a)
        for (unsigned int b = 0; b < expected.m(); ++b)
          EXPECT_NEAR(mass.nodal().el(a, b), expected(a, b), 1e-12);
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
