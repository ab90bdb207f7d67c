// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_pose_quality_h
#define exemplar_pose_quality_h

namespace Exemplar
{
  /// Quality of a pose on tetrahedra. Stretches are singular values of F, over all cells.
  struct PoseQuality
  {
    unsigned int n_inverted = 0;
    double       min_det = 0., max_det = 0.;
    double       min_stretch = 0., stretch_1 = 0., stretch_99 = 0., max_stretch = 0.;
    double       mean_error = 0., max_error = 0.; ///< distances to the pose, over its diagonal
    double       longest_edge = 0.; ///< carried over posed length, greatest ratio of an edge
    double       rotation     = 0.; ///< angle of the rigid motion that was removed [degrees]
    double       shift        = 0.; ///< displacement of the boundary's middle by that motion [m]
    unsigned int iterations = 0, releases = 0;
  };
} // namespace Exemplar

#endif
