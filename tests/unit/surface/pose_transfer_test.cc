// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/mesh/mesh.h>
#include <exemplar/surface/posing/pose_carrying.h>

#include "fold_bodies.h"
#include "matrices.h"

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    /// A bar that hangs on its own boundary, or on that of a finer one.
    class PoseTransferTest : public testing::Test
    {
    protected:
      Points
      carry(const Mesh &skin, const Points &pose, const double attach = 30.)
      {
        PoseTransfer transfer(bar.get_nodes(), bar.get_cells(),
                              SurfaceAttachment(bar.get_nodes(), bar.get_boundary_faces(),
                                                boundary_of(skin, skin.get_nodes())),
                              attach);
        return transfer.carry(vertices(pose), quality);
      }

      const Mesh  bar = small_bar(), fine = small_bar(5);
      PoseQuality quality;
    };

    TEST_F(PoseTransferTest, TheRestSurfaceGivesTheRestMesh)
    {
      for (const Mesh *skin : { &bar, &fine })
      {
        EXPECT_LT(max_distance_between(carry(*skin, skin->get_nodes()), bar.get_nodes()), 1e-9);
        EXPECT_NEAR(quality.min_det, 1., 1e-9);
        EXPECT_NEAR(quality.max_stretch, 1., 1e-9);
        EXPECT_LT(quality.max_error, 1e-9);
        EXPECT_NEAR(quality.rotation, 0., 1e-6);
      }
    }

    TEST_F(PoseTransferTest, ARigidMotionIsCarriedAndReported)
    {
      const Matrix3<double>  R = rotation_about({ { 1., -2., .5 } }, 2.);
      const dealii::Point<3> shift(5., -7., 1.);
      const auto             move = [&](const dealii::Point<3> &x)
      {
        dealii::Point<3> y = shift;
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            y[i] += R[i][j] * x[j];
        return y;
      };
      EXPECT_LT(max_distance_between(carry(fine, mapped(fine.get_nodes(), move)),
                                     mapped(bar.get_nodes(), move)),
                1e-9);
      EXPECT_NEAR(quality.rotation, 2. * 180. / M_PI, 1e-6);
      // the centroid of the boundary's nodes is (2, 0, 0)
      EXPECT_NEAR(quality.shift, move({ 2., 0., 0. }).distance({ 2., 0., 0. }), 1e-9);
    }

    TEST_F(PoseTransferTest, FollowsABendMoreCloselyTheStrongerItIsAttached)
    {
      double before = 1.;
      for (const double attach : { 0.3, 3., 30. })
      {
        const Points x = carry(fine, bent(fine.get_nodes(), 2.5), attach);
        EXPECT_EQ(quality.n_inverted, 0u);
        EXPECT_LT(quality.mean_error, before);
        before = quality.mean_error;
        EXPECT_GT(quality.min_det, 0.1);
        EXPECT_LE(quality.min_stretch, quality.stretch_1);
        EXPECT_LE(quality.stretch_1, quality.stretch_99);
        EXPECT_LE(quality.stretch_99, quality.max_stretch);
      }
      EXPECT_LT(before, 2e-3);
    }

    TEST_F(PoseTransferTest, NoCellOfACrushedOrKnottedPoseIsInverted)
    {
      const auto folded = [](const dealii::Point<3> &x) // the right half back over the left one
      { return dealii::Point<3>(x[0] < 2. ? x[0] : 4. - x[0], x[1], x[2]); };
      const auto twisted = [](const dealii::Point<3> &x) // candy wrapper: the mean of two turns
      {
        const double share = std::max(0., std::min(1., x[0] - 1.5)), c = 1. - 2. * share;
        return dealii::Point<3>(x[0], c * x[1], c * x[2]);
      };
      const auto flat
          = [](const dealii::Point<3> &x) { return dealii::Point<3>(x[0], x[1], 0.01 * x[2]); };
      for (const auto &pose : { mapped(fine.get_nodes(), folded), mapped(fine.get_nodes(), twisted),
                                mapped(fine.get_nodes(), flat) })
      {
        carry(fine, pose);
        EXPECT_EQ(quality.n_inverted, 0u);
        EXPECT_GT(quality.min_det, FoldSolver::margin);
        carry(fine, pose, 1000.);
        EXPECT_EQ(quality.n_inverted, 0u);
        EXPECT_GT(quality.min_det, FoldSolver::margin);
      }
    }

    TEST_F(PoseTransferTest, TheLengthUnitDoesNotMatter)
    {
      const auto in_millimetres = [](const dealii::Point<3> &x)
      { return dealii::Point<3>(1000. * x[0], 1000. * x[1], 1000. * x[2]); };
      const Points pose = bent(fine.get_nodes(), 2.), x = carry(fine, pose);
      const Points nodes = mapped(bar.get_nodes(), in_millimetres);
      PoseTransfer transfer(
          nodes, bar.get_cells(),
          SurfaceAttachment(nodes, bar.get_boundary_faces(),
                            boundary_of(fine, mapped(fine.get_nodes(), in_millimetres))),
          30.);
      EXPECT_LT(
          max_distance_between(transfer.carry(vertices(mapped(pose, in_millimetres)), quality),
                               mapped(x, in_millimetres)),
          1e-6);
    }
  } // namespace
} // namespace Exemplar::Testing
