// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_keyed_shapes_h
#define exemplar_live_keyed_shapes_h

#include <exemplar/live/run_motion.h>

#include <array>
#include <optional>

namespace Exemplar::Live
{
  /// A frame of a motion: vertex v stands at q (rest_v + sum_i w_i target_i,v) q* + t.
  struct ShapeKey
  {
    std::array<float, 4> rotation;    ///< unit quaternion q: x, y, z, w
    std::array<float, 3> translation; ///< t [m]
    std::vector<float>   weights;     ///< one a target
  };

  /// A motion as weights of shapes on a body that moves rigidly, all in single precision: targets
  /// are displacements from rest.
  struct KeyedShapes
  {
    Places                rest;
    std::vector<Places>   targets; ///< the examples, then the shapes
    std::vector<ShapeKey> keys;    ///< by frame
    std::size_t           n_examples = 0;
    double                error      = 0.; ///< largest distance of a vertex from its frame [m]
    double                diagonal   = 0.; ///< of the box around the body at rest [m]

    /// Unit normals at rest, and what each target adds to them in the least-squares sense over the
    /// frames; empty unless asked for.
    Places              rest_normals   = {};
    std::vector<Places> target_normals = {};

    std::size_t
    n_shapes() const
    {
      return targets.size() - n_examples;
    }

    /// Where a player shows the vertices in a frame [m].
    Places
    places(std::size_t frame) const;
  };

  /// The error, relative to the diagonal, that decides how many shapes there are by default.
  constexpr double default_error_of_shapes = 0.005;

  /// The same of a run with contact, whose surfaces are as near to each other as default_error_of_shapes.
  constexpr double default_error_in_contact = 0.0005;

  /// Examples keep the weights of the run. Of what is left the first shape is the mean of all
  /// frames, with the weight 1, and the others are singular vectors, largest first, with weights
  /// from 0 to 1: `n_shapes` in all, fewer if nothing is left, or as many as bring all vertices
  /// within the default error. Rigid motions are those that bring the body at rest nearest to
  /// each frame.
  KeyedShapes
  keyed_shapes(const RunMotion                   &motion,
               const std::optional<unsigned int> &n_shapes,
               bool                               with_normals);
} // namespace Exemplar::Live

#endif
