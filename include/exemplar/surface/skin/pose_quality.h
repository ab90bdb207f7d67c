// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_pose_quality_h
#define exemplar_pose_quality_h

#include <array>
#include <string>

namespace Exemplar
{
  /// Quality of a pose on tetrahedra. Stretches are singular values of F, over all cells.
  struct PoseQuality
  {
    unsigned int n_inverted = 0;
    double       min_det = 0., max_det = 0.;
    double       min_stretch = 0., stretch_1 = 0., stretch_99 = 0., max_stretch = 0.;
    double       mean_error = 0., max_error = 0.; ///< distances to the pose, over its diagonal
    /// The farthest vertex, from 1, and its place in the pose [unit of the file].
    std::size_t           vertex = 0;
    std::array<double, 3> vertex_place{};
    /// Greatest displacement of a vertex from rest, less the rigid motion, over the diagonal.
    double motion       = 0.;
    double longest_edge = 0.; ///< carried over posed length, greatest ratio of an edge
    double edge_at_rest = 0.; ///< length of that edge at rest over posed length
    /// Its vertices, from 1, and the middle between them in the pose [unit of the file].
    std::array<std::size_t, 2> edge{};
    std::array<double, 3>      edge_place{};
    double       rotation   = 0.; ///< angle of the rigid motion that was removed [degrees]
    double       shift      = 0.; ///< displacement of the boundary's middle by that motion [m]
    unsigned int iterations = 0, releases = 0;

    /// An edge that becomes longer than this times its length in the file hangs on a part of the
    /// body which is not its own, or the pose shortens it so much that cells cannot follow.
    static constexpr double tolerable_edge = 3.;

    /// A sentence on the longest edge, if it is longer than that; otherwise empty.
    std::string
    warning_of_edge() const;

    /// A pose is hardly followed if a vertex stays this share of `motion` away from it. What stays
    /// less than least_visible of the diagonal away is not seen.
    static constexpr double hardly_followed = .5, least_visible = .001;

    /// A sentence on the farthest vertex, if the pose is hardly followed there; otherwise empty.
    std::string
    warning_of_motion() const;
  };
} // namespace Exemplar

#endif
