// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_closest_features_h
#define exemplar_closest_features_h

#include <deal.II/base/tensor.h>

#include <array>

namespace Exemplar
{
  using SpaceVector3 = dealii::Tensor<1, 3>;

  /// Where two flat features (points, edges, triangles) A and B are nearest: v = sum a_i x_i - sum b_j q_j with corners
  /// x of A and q of B. The derivatives by the parameters of the two points that are free there, of which there are two
  /// at most, are what the second derivative of the distance needs.
  struct Nearest
  {
    SpaceVector3          way; ///< v [m]
    std::array<double, 3> a{}, b{};
    unsigned int          n_free = 0;
    /// da/dtheta and db/dtheta of each free parameter theta.
    std::array<std::array<double, 3>, 2> da{}, db{};
    /// dv/dtheta [m] of each.
    std::array<SpaceVector3, 2> dv{};
  };

  /// The point of a triangle A that is nearest to a point B: regions of vertices, edges and the face. A triangle
  /// without area is its edges.
  Nearest
  nearest(const std::array<SpaceVector3, 3> &triangle, const SpaceVector3 &point);

  /// The same of an edge A and an edge B; of parallel edges, the best of the clamped candidates. Edges may be points.
  Nearest
  nearest(const std::array<SpaceVector3, 2> &edge, const std::array<SpaceVector3, 2> &other);

  /// The same with the roles exchanged: A is B.
  Nearest
  reversed(const Nearest &of);

  /// Whether an edge passes through a triangle, its corners and rims included; for rounding's sake not for edges that
  /// touch. An edge in the plane of the triangle does not.
  bool
  passes_through(const std::array<SpaceVector3, 2> &edge,
                 const std::array<SpaceVector3, 3> &triangle);
} // namespace Exemplar

#endif
