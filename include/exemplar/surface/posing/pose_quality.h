// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_pose_quality_h
#define exemplar_pose_quality_h

namespace Exemplar
{
  /// What a pose on tetrahedra is like. Stretches are singular values of F, of all cells.
  struct PoseQuality
  {
    unsigned int n_inverted = 0;
    double       min_det = 0., max_det = 0.;
    double       min_stretch = 0., stretch_1 = 0., stretch_99 = 0., max_stretch = 0.;
    double       mean_error = 0., max_error = 0.; ///< over the diagonal, see PoseTransfer
    double       longest_edge = 0.; ///< of the surface as it is carried, over its own in the pose
    double       rotation     = 0.; ///< of the rigid motion that was stripped [degrees]
    double       shift        = 0.; ///< of the body's boundary [m]
    unsigned int iterations = 0, releases = 0;
  };
} // namespace Exemplar

#endif
