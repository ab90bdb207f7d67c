// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/kernels/polar_decomposition.h>
#include <exemplar/mesh/rigid_motion.h>

#include <deal.II/base/exceptions.h>

#include <cmath>

namespace Exemplar
{
  namespace
  {
    using Tensor1 = dealii::Tensor<1, 3>;
    using Points  = std::vector<dealii::Point<3>>;

    Tensor1
    operator*(const Matrix3<double> &A, const Tensor1 &b)
    {
      Tensor1 c;
      for (int i = 0; i < 3; ++i)
        c[i] = A[i][0] * b[0] + A[i][1] * b[1] + A[i][2] * b[2];
      return c;
    }

    Matrix3<double>
    transpose(const Matrix3<double> &A)
    {
      return transpose_times(A, identity_matrix<double>());
    }

    /// B of Eq. (15).
    Matrix3<double>
    covariance(const RigidMotion &centroids, const Points &points, const Points &targets)
    {
      Matrix3<double> B{};
      for (std::size_t point = 0; point < points.size(); ++point)
      {
        const Tensor1 p = targets[point] - centroids.to, q = points[point] - centroids.from;
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            B[i][j] += p[i] * q[j];
      }
      return B;
    }

    /// Whether the second singular value is at most 1e-10 of the first: it is the square of the
    /// points' relative distance from a line, and coordinates in files may have six digits.
    bool
    is_of_rank_one(const Matrix3<double> &B)
    {
      const Matrix3<double> cof = cofactors(B);
      return std::sqrt(contract(cof, cof)) <= 1e-10 * contract(B, B);
    }

    /// A unit vector perpendicular to a unit vector.
    Tensor1
    perpendicular(const Tensor1 &u)
    {
      int minimum = 0;
      for (int d = 1; d < 3; ++d)
        if (std::abs(u[d]) < std::abs(u[minimum]))
          minimum = d;
      Tensor1 e;
      e[minimum]      = 1.;
      const Tensor1 n = dealii::cross_product_3d(u, e);
      return n / n.norm();
    }

    Matrix3<double>
    rotation_by(const AxisAngle &turn)
    {
      const double s = std::sin(0.5 * turn.angle);
      return Polar::rotation_matrix(Polar::Quaternion<double>{
          { std::cos(0.5 * turn.angle), s * turn.axis[0], s * turn.axis[1], s * turn.axis[2] } });
    }

    /// The smallest rotation that takes the unit vector `from` to `to`.
    Matrix3<double>
    smallest_rotation(const Tensor1 &from, const Tensor1 &to)
    {
      const Tensor1 normal = dealii::cross_product_3d(from, to);
      const double  sine   = normal.norm();
      const double  angle  = std::atan2(sine, from * to);
      return rotation_by({ sine > 1e-12 ? Tensor1(normal / sine) : perpendicular(from), angle });
    }

    /// The smallest of the rotations nearest to B = s u v^T: it takes v to u.
    Matrix3<double>
    closest_rotation_of_rank_one(const Matrix3<double> &B)
    {
      Tensor1 v;
      for (int i = 0; i < 3; ++i)
        if (const Tensor1 row({ B[i][0], B[i][1], B[i][2] }); row.norm() > v.norm())
          v = row;
      if (v.norm() == 0.)
        return identity_matrix<double>();
      const Tensor1 u = B * (v / v.norm());
      v               = transpose(B) * u; // a step of the power method, as B is nearly of rank one
      return smallest_rotation(v / v.norm(), u / u.norm());
    }
  } // namespace

  dealii::Point<3>
  centroid(const std::vector<dealii::Point<3>> &points)
  {
    dealii::Point<3> sum;
    for (const dealii::Point<3> &x : points)
      sum += x;
    return dealii::Point<3>(sum / static_cast<double>(points.size()));
  }

  bool
  are_collinear(const std::vector<dealii::Point<3>> &points)
  {
    const dealii::Point<3> center = centroid(points);
    return is_of_rank_one(covariance({ center, center, {} }, points, points));
  }

  dealii::Point<3>
  RigidMotion::operator()(const dealii::Point<3> &x) const
  {
    return to + rotation * Tensor1(x - from);
  }

  RigidMotion
  best_rigid_motion(const std::vector<dealii::Point<3>> &points,
                    const std::vector<dealii::Point<3>> &targets)
  {
    AssertDimension(points.size(), targets.size());
    RigidMotion           motion{ centroid(points), centroid(targets), {} };
    const Matrix3<double> B = covariance(motion, points, targets);
    motion.rotation = is_of_rank_one(B) ? closest_rotation_of_rank_one(B) : closest_rotation(B);
    return motion;
  }

  AxisAngle
  axis_and_angle(const Matrix3<double> &rotation)
  {
    // Horn's matrix of the rotation with the unit quaternion q is 4 q q^T - I
    const Polar::Matrix4<double> K       = Polar::horn_matrix(rotation);
    int                          longest = 0;
    for (int i = 1; i < 4; ++i)
      if (K.value[i][i] > K.value[longest][longest])
        longest = i;
    double  w = K.value[0][longest] + (longest == 0 ? 1. : 0.);
    Tensor1 v;
    for (int i = 0; i < 3; ++i)
      v[i] = K.value[i + 1][longest] + (longest == i + 1 ? 1. : 0.);

    const double sine = v.norm();
    if (sine == 0.)
      return { v, 0. };
    const Tensor1 axis         = v / sine;
    const bool    is_half_turn = std::abs(w) < 1e-8 * sine;
    int           first        = 0;
    while (std::abs(axis[first]) < 0.1)
      ++first;
    const bool flip = is_half_turn ? axis[first] < 0. : w < 0.;
    return { flip ? -axis : axis, 2. * std::atan2(sine, flip ? -w : w) };
  }

  AxisAngle
  rigid_turn(const std::vector<dealii::Point<3>> &from, const std::vector<dealii::Point<3>> &to)
  {
    const RigidMotion motion = best_rigid_motion(from, to);
    double            miss = 0., size = 0.;
    for (std::size_t i = 0; i < from.size(); ++i)
    {
      miss += (to[i] - motion(from[i])).norm_square();
      size += (from[i] - motion.from).norm_square();
    }
    return miss <= 0.01 * size ? axis_and_angle(motion.rotation) : AxisAngle{ {}, 0. };
  }

  RigidMotion
  interpolate(const RigidMotion &motion, const double progress)
  {
    AxisAngle turn = axis_and_angle(motion.rotation);
    turn.angle *= progress;
    return { motion.from, motion.from + progress * (motion.to - motion.from), rotation_by(turn) };
  }

  RigidPath::RigidPath(const std::vector<dealii::Point<3>> &points,
                       const std::vector<dealii::Point<3>> &targets)
      : motion(best_rigid_motion(points, targets)), points(points)
  {
    const Matrix3<double> back = transpose(motion.rotation);
    for (std::size_t point = 0; point < points.size(); ++point)
      remainders.push_back(back * Tensor1(targets[point] - motion(points[point])));
  }

  dealii::Tensor<1, 3>
  RigidPath::displacement(const unsigned int point, const double progress) const
  {
    const RigidMotion part = interpolate(motion, progress);
    const Tensor1     arm  = points[point] - part.from;
    // in this order the sum is exactly 0 at progress 0
    return (part.to - part.from) + (part.rotation * arm - arm)
           + progress * (part.rotation * remainders[point]);
  }
} // namespace Exemplar
