// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/supports.h>

#include "body.h"
#include "matrices.h"

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    std::vector<unsigned int>
    dofs_of(const Mesh                          &mesh,
            const std::vector<dealii::Point<3>> &places,
            const std::string                   &components)
    {
      std::vector<unsigned int> dofs;
      for (const dealii::Point<3> &place : places)
        for (unsigned int node = 0; node < mesh.n_nodes(); ++node)
          if (mesh.get_nodes()[node].distance(place) < 1e-12)
            for (const char c : components)
              dofs.push_back(3 * node + (c - 'x'));
      return dofs;
    }

    TEST(Supports, CountsFreeRigidMotions)
    {
      const Mesh             mesh(box_mesh(4., 4, 2));
      const dealii::Point<3> a(0, 0, 0), b(4, 0, 0), c(0, 0.5, 0), middle(2, 0, 0);
      EXPECT_EQ(n_free_rigid_motions(mesh, FESpace(mesh), {})[0], 6u);
      EXPECT_EQ(n_free_rigid_motions(mesh, FESpace(mesh), dofs_of(mesh, { a }, "xyz"))[0], 3u);
      EXPECT_EQ(n_free_rigid_motions(mesh, FESpace(mesh), dofs_of(mesh, { a, b }, "xyz"))[0], 1u);
      EXPECT_EQ(
          n_free_rigid_motions(mesh, FESpace(mesh), dofs_of(mesh, { a, middle, b }, "xyz"))[0],
          1u); // on a line
      EXPECT_EQ(n_free_rigid_motions(mesh, FESpace(mesh), dofs_of(mesh, { a, b, c }, "xyz"))[0],
                0u);
      EXPECT_EQ(n_free_rigid_motions(mesh, FESpace(mesh), dofs_of(mesh, { a, b, c }, "z"))[0], 3u);
      EXPECT_EQ(n_free_rigid_motions(mesh, FESpace(mesh), dofs_of(mesh, { a, b, c }, "yz"))[0], 1u);
    }

    TEST(Supports, NearTheCentroidHoldsSixMotionsWithSixDofs)
    {
      for (const double length : { 0.3, 1., 7. })
      {
        const Mesh mesh(box_mesh(length, 3, 2));
        const auto support = support_near_centroid(mesh.get_nodes(), mesh.get_cells());
        EXPECT_EQ(support.held_dofs.size(), 6u);
        EXPECT_EQ(n_free_rigid_motions(mesh, FESpace(mesh), support.held_dofs)[0], 0u);
      }
    }

    TEST(Supports, AlignUndoesARigidMotion)
    {
      const Body            body;
      const Matrix3<double> Q     = rotation_about({ { 1., 2., -1. } }, 3.);
      const auto           &rest  = body.fe_space.rest_positions();
      auto                  moved = rest;
      for (unsigned int node = 0; node < body.fe_space.n_nodes(); ++node)
      {
        const Vector3<double> x = { { rest[3 * node], rest[3 * node + 1], rest[3 * node + 2] } };
        const Vector3<double> y = Q * x;
        for (int c = 0; c < 3; ++c)
          moved[3 * node + c] = y[c] + 10. * c;
      }
      align(rest, moved, Exchange::serial());
      moved -= rest;
      EXPECT_LT(moved.linfty_norm(), 1e-13);
    }
  } // namespace
} // namespace Exemplar::Testing
