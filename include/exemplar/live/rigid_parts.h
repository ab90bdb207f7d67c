// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_rigid_parts_h
#define exemplar_live_rigid_parts_h

#include <exemplar/live/run_motion.h>

#include <array>
#include <string>
#include <vector>

namespace Exemplar::Live
{
  /// A connected part of a surface that moves rigidly. In a frame its vertices are at size (q v q*) + t.
  struct RigidPart
  {
    /// A frame of its motion.
    struct Key
    {
      std::array<float, 4> rotation;    ///< unit quaternion q: x, y, z, w
      std::array<float, 3> translation; ///< t [m]
      float                size;        ///< 1; 0: the part is not there
    };

    Places                                   vertices;  ///< v [m], about their centroid
    std::vector<std::array<unsigned int, 3>> triangles; ///< counterclockwise from where it is seen
    std::vector<Key>                         keys;      ///< by frame
    double error = 0.; ///< largest distance of a vertex from its frame [m]
  };

  /// The connected parts of polygons, in the order of their first vertices. All vertices of a part that is not there are in
  /// one place.
  std::vector<RigidPart>
  rigid_parts(const std::vector<std::vector<unsigned int>> &polygons,
              const std::vector<Places>                    &frames);

  /// The obstacles of a run that move rigidly to `most_off` [m]; `notes` tell of those that do not, which are left out.
  std::vector<RigidPart>
  rigid_obstacles(const RunMotion &motion, double most_off, std::vector<std::string> &notes);

  /// A rotation as unit quaternion x, y, z, w, the one of q and -q that is nearer to `before`, so that players turn the
  /// short way.
  std::array<float, 4>
  quaternion_of(const Matrix3<double> &rotation, const std::array<float, 4> *before);
} // namespace Exemplar::Live

#endif
