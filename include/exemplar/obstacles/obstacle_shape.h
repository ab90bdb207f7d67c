// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_obstacle_shape_h
#define exemplar_obstacle_shape_h

#include <exemplar/obstacles/closest_features.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  struct TriangleSurface;

  /// The forms of Obstacles/NAME/Shape, for messages.
  extern const std::string obstacle_forms;

  /// What an obstacle is made of, in axes of its own with their origin in its middle. The body's distance is that of
  /// its nodes from half spaces, the solid box and the triangles; of its edges from the edges; of its triangles from
  /// the points; all less the radius.
  struct ObstacleShape
  {
    /// The half space n.x <= offset is the obstacle.
    struct HalfSpace
    {
      SpaceVector3 normal;
      double       offset; ///< [m]
    };

    SpaceVector3                             middle; ///< where it is at first [m]
    std::vector<HalfSpace>                   half_spaces;
    std::optional<SpaceVector3>              half_sizes; ///< of the solid box [m]
    std::vector<SpaceVector3>                vertices;   ///< [m]
    std::vector<unsigned int>                points;
    std::vector<std::array<unsigned int, 2>> edges;
    std::vector<std::array<unsigned int, 3>> triangles; ///< of a surface
    std::vector<unsigned int> flat_parts;        ///< by triangle: the first one of its flat part
    double                    radius    = 0.;    ///< around points and edges [m]
    bool                      is_closed = true;  ///< whether it has an inside
    bool                      bounds    = false; ///< whether the body is inside of it, as in a box

    /// Whether nodes may meet the edges: those of a capsule.
    bool
    edges_meet_nodes() const
    {
      return triangles.empty() && !half_sizes && !edges.empty();
    }

    bool
    is_surface() const
    {
      return !triangles.empty();
    }

    /// Let all of it but a surface be farther from the body, by this [m].
    void
    set_back(double by);
  };

  /// A shape by its text. Throws UserError, calling it `key`, for what is none of obstacle_forms and for the wrong
  /// numbers; "surface FILE" is of the other function.
  ObstacleShape
  parse_shape(const std::string &text, const std::string &key);

  /// The shape of a surface [m], of which vertices that no triangle uses are left out. Neighbours in one plane, but for rounding, are
  /// one flat part unless the surface deforms: edges and points within it are none of the obstacle.
  ObstacleShape
  shape_of(const TriangleSurface &surface, bool deforms);

  /// The FILE of "surface FILE"; empty for other shapes.
  std::string
  file_of_shape(const std::string &text);
} // namespace Exemplar

#endif
