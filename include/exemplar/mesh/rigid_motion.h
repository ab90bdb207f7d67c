// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_rigid_motion_h
#define exemplar_rigid_motion_h

#include <exemplar/kernels/matrix3.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <vector>

namespace Exemplar
{
  /// The mean of the points.
  dealii::Point<3>
  centroid(const std::vector<dealii::Point<3>> &points);

  /// Whether the points lie on one line (also if they coincide), to 1e-5 of their extent.
  bool
  are_collinear(const std::vector<dealii::Point<3>> &points);

  /// x -> to + R (x - from).
  struct RigidMotion
  {
    dealii::Point<3> from, to;
    Matrix3<double>  rotation;

    dealii::Point<3>
    operator()(const dealii::Point<3> &x) const;
  };

  /// The motion of `points` that comes nearest to `targets`, as many, in the
  /// least-squares sense (Kabsch 1976), Eq. (15); `from` and `to` are the centroids.
  /// Where several rotations do equally well, because either set lies on a line, it
  /// is the smallest one: a single point does not turn.
  RigidMotion
  best_rigid_motion(const std::vector<dealii::Point<3>> &points,
                    const std::vector<dealii::Point<3>> &targets);

  /// A rotation by an angle [rad], from 0 to pi (to rounding), about a unit axis (0 without
  /// a rotation). A half turn goes either way; here the first component of its axis
  /// that is not small is positive.
  struct AxisAngle
  {
    dealii::Tensor<1, 3> axis;
    double               angle;
  };

  AxisAngle
  axis_and_angle(const Matrix3<double> &rotation);

  /// Of the way from some points to others, as many: how it turns them if it is a rigid motion, but
  /// for a tenth of their size; else no rotation.
  AxisAngle
  rigid_turn(const std::vector<dealii::Point<3>> &from, const std::vector<dealii::Point<3>> &to);

  /// A part of the motion: `to` on the straight way from `from`, the rotation about the
  /// same axis by `progress` times the angle (slerp). 0 gives the identity, 1 the motion;
  /// any other progress is allowed.
  RigidMotion
  interpolate(const RigidMotion &motion, double progress);

  /// Points on their way to targets: moved rigidly together, and what a rigid motion
  /// leaves over added in proportion and turned along.
  class RigidPath
  {
  public:
    RigidPath(const std::vector<dealii::Point<3>> &points,
              const std::vector<dealii::Point<3>> &targets);

    /// Of a point from its start [m]: exactly 0 at progress 0; at 1 it is at its
    /// target to rounding. Progress is extrapolated beyond.
    dealii::Tensor<1, 3>
    displacement(unsigned int point, double progress) const;

  private:
    RigidMotion                       motion;
    std::vector<dealii::Point<3>>     points;
    std::vector<dealii::Tensor<1, 3>> remainders; ///< turned back
  };
} // namespace Exemplar

#endif
