// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_rigid_motion_h
#define exemplar_rigid_motion_h

#include <exemplar/kernels/matrix3.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <vector>

namespace Exemplar
{
  /// The centroid of the points.
  dealii::Point<3>
  centroid(const std::vector<dealii::Point<3>> &points);

  /// Whether the points are collinear (also if they coincide), to 1e-5 of their extent.
  bool
  are_collinear(const std::vector<dealii::Point<3>> &points);

  /// The rigid motion x -> to + R (x - from).
  struct RigidMotion
  {
    dealii::Point<3> from, to;
    Matrix3<double>  rotation;

    dealii::Point<3>
    operator()(const dealii::Point<3> &x) const;
  };

  /// The motion of `points` that comes nearest to `targets`, as many, in the least-squares sense
  /// (Kabsch 1976), Eq. (15); `from` and `to` are the centroids. Where the rotation is not unique,
  /// because either set is collinear, it is the smallest one: a single point does not rotate.
  RigidMotion
  best_rigid_motion(const std::vector<dealii::Point<3>> &points,
                    const std::vector<dealii::Point<3>> &targets);

  /// A rotation by an angle [rad], from 0 to pi (to rounding), about a unit axis (0 without a
  /// rotation). The axis of a half turn is unique up to sign; here its first component that is not
  /// small is positive.
  struct AxisAngle
  {
    dealii::Tensor<1, 3> axis;
    double               angle;
  };

  AxisAngle
  axis_and_angle(const Matrix3<double> &rotation);

  /// The rotation from some points to as many others if this is a rigid motion up to a tenth of
  /// their size; otherwise no rotation.
  AxisAngle
  rigid_turn(const std::vector<dealii::Point<3>> &from, const std::vector<dealii::Point<3>> &to);

  /// A fraction of a motion: `to` on the straight line from `from`, the rotation about the same
  /// axis by `progress` times the angle (slerp). 0 gives the identity, 1 the motion; any other
  /// progress is allowed.
  RigidMotion
  interpolate(const RigidMotion &motion, double progress);

  /// Interpolation of points to targets: a rigid motion, plus the remainder of the displacement,
  /// which grows in proportion and rotates along.
  class RigidPath
  {
  public:
    RigidPath(const std::vector<dealii::Point<3>> &points,
              const std::vector<dealii::Point<3>> &targets);

    /// Displacement of a point from its start [m]: exactly 0 at progress 0; at 1 the point is at
    /// its target to rounding. Progress is extrapolated beyond.
    dealii::Tensor<1, 3>
    displacement(unsigned int point, double progress) const;

  private:
    RigidMotion                       motion;
    std::vector<dealii::Point<3>>     points;
    std::vector<dealii::Tensor<1, 3>> remainders; ///< rotated back to the start
  };
} // namespace Exemplar

#endif
