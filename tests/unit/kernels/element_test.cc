// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/mass.h>

#include "body.h"

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    class Elements : public testing::TestWithParam<std::size_t>
    {
    protected:
      const Element       element = static_cast<Element>(GetParam());
      const ElementTraits traits  = traits_of(element);
      const Body          body{ box_mesh(1., 1, 1), MaterialParameters(), element };
      const FESpace      &space = body.fe_space;

      /// Of the volume.
      std::vector<double>
      shares(const ShareRule rule) const
      {
        std::vector<double> values(space.n_nodes(), 0.);
        for (unsigned int cell = 0; cell < space.n_cells(); ++cell)
          space.share_out(space.cell_volume(cell), rule, cell, values);
        return values;
      }
    };

    TEST_P(Elements, HaveANodeForEachCoefficientOfTheirPolynomials)
    {
      const int p = traits.degree;
      EXPECT_EQ(traits.nodes_per_cell, (p + 1) * (p + 2) * (p + 3) / 6);
      EXPECT_EQ(space.nodes(0).size(), static_cast<std::size_t>(traits.nodes_per_cell));
      EXPECT_EQ(space.n_points(),
                space.n_cells() * static_cast<unsigned int>(traits.points_per_cell));
    }

    TEST_P(Elements, AreCalledWithTheirConstant)
    {
      EXPECT_EQ(with_element(element, [](const auto of) { return of(); }), element);
    }

    TEST_P(Elements, ShareOutByTheIntegralsOfShapeFunctions)
    {
      const Mass                mass(space, body.material, MassMatrix::consistent);
      const std::vector<double> consistent = shares(ShareRule::consistent);
      for (unsigned int a = 0; a < space.n_nodes(); ++a)
      {
        double row_sum = 0.;
        for (unsigned int b = 0; b < space.n_nodes(); ++b)
          row_sum += mass.nodal().el(a, b);
        EXPECT_NEAR(1000. * consistent[a], row_sum, 1e-10);
      }
    }

    TEST_P(Elements, LumpByTheIntegralsOfTheirSquares)
    {
      const Mass                mass(space, body.material, MassMatrix::consistent);
      const std::vector<double> lumped = shares(ShareRule::lumped);
      double                    total = 0., diagonal = 0.;
      for (unsigned int a = 0; a < space.n_nodes(); ++a)
      {
        total += lumped[a];
        diagonal += mass.nodal().el(a, a);
      }
      EXPECT_NEAR(total, 1., 1e-14);
      for (unsigned int a = 0; a < space.n_nodes(); ++a)
        EXPECT_NEAR(lumped[a], mass.nodal().el(a, a) / diagonal, 1e-14);
    }

    TEST_P(Elements, ShareOutOnFacesAboutTheCentroid)
    {
      // a constant traction has its centre in the centroid
      for (const BoundaryFace &face : body.mesh.get_boundary_faces())
      {
        const std::vector<unsigned int> nodes = space.numbering().of_face(face);
        for (const ShareRule rule : { ShareRule::consistent, ShareRule::lumped })
        {
          std::vector<double> values(space.n_nodes(), 0.);
          space.share_out(3., rule, face, values);
          dealii::Point<3> middle, centroid;
          double           sum = 0.;
          for (const unsigned int node : nodes)
          {
            sum += values[node];
            middle += values[node] / 3. * dealii::Tensor<1, 3>(space.rest_position(node));
          }
          for (const unsigned int vertex : face.nodes)
            centroid += dealii::Tensor<1, 3>(space.rest_position(vertex)) / 3.;
          EXPECT_NEAR(sum, 3., 1e-14);
          EXPECT_LT(middle.distance(centroid), 1e-14);
        }
      }
    }

    INSTANTIATE_TEST_SUITE_P(All,
                             Elements,
                             testing::Range<std::size_t>(0, std::size(element_traits)));
  } // namespace
} // namespace Exemplar::Testing
