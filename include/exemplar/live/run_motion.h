// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_run_motion_h
#define exemplar_live_run_motion_h

#include <exemplar/surface/shape/surface_mesh.h>

#include <deal.II/base/point.h>

#include <filesystem>
#include <string>
#include <vector>

namespace Exemplar::Live
{
  /// Places of vertices [m].
  using Places = std::vector<dealii::Point<3>>;

  /// A surface that moves in a run.
  struct MovingSurface
  {
    std::string           name;
    SurfaceMesh           surface;              ///< its faces and what the file says of them
    std::filesystem::path folder        = {};   ///< of the file that it was read from; empty: none
    bool                  is_of_body    = true; ///< else one of Mesh/Carry
    std::size_t           first_in_list = 0;    ///< its first vertex in lists of places
  };

  /// The surfaces of a finished run, the body's first, in motion. Lists of places hold the vertices
  /// of all surfaces, one after the other.
  struct RunMotion
  {
    std::vector<MovingSurface>       surfaces;
    Places                           rest;
    std::vector<Places>              examples; ///< poses of the examples that differ from rest
    std::vector<std::string>         names;    ///< of the examples
    std::vector<Places>              frames;
    std::vector<std::vector<double>> weights; ///< by frame, one an example
    std::vector<double>              times;   ///< at which a player shows the frames [s]
    bool                             z_is_up     = false; ///< else y is
    bool                             has_contact = false; ///< obstacles, or surfaces that meet
    std::vector<std::string>         names_of_obstacles;  ///< in the order of their surfaces
    std::vector<std::vector<unsigned int>> obstacles;     ///< their polygons; empty: none are shown
    std::vector<Places>      obstacle_frames; ///< places of the vertices of these, by frame
    std::vector<std::string> notes;           ///< what could not be taken over, sentences
  };

  /// Read the motion of the surface that a run carries, with what it wears, from its point caches;
  /// of a run without one, that of the body's boundary from its frames in the format vtu. Throws
  /// UserError for a directory that is not that of a finished run, for files that are missing, and
  /// for those that the run has not written or that have changed since.
  RunMotion
  motion_of_run(const std::filesystem::path &directory);
} // namespace Exemplar::Live

#endif
