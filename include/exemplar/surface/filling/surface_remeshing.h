// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_surface_remeshing_h
#define exemplar_surface_remeshing_h

#include <exemplar/surface/shape/triangle_surface.h>
#include <exemplar/surface/shape/vectors.h>

namespace Exemplar
{
  /// A closed, oriented manifold surface with edges of about `edge_length`, its vertices on the
  /// surface given (isotropic remeshing, Botsch and Kobbelt 2004, by CGAL). The borders of groups
  /// stay where they are; with `keep_edges` so do edges sharper than 60 degrees, where they make
  /// chains of several times the edge length: short ones are noise. The triangles that are `held`
  /// stay as they are, but for vertices on edges that they share with others; none: all may change.
  TriangleSurface
  remesh(const TriangleSurface   &surface,
         double                   edge_length,
         bool                     keep_edges,
         const std::vector<bool> &held = {});

  /// What becomes of a triangle.
  enum class Treatment : unsigned char
  {
    free,    ///< remeshed with edges of the length that is asked for
    thinned, ///< held, but remeshed once with edges of another length
    held     ///< stays as it is
  };

  /// Remeshes those triangles of a surface alone that are to be thinned, to edges of about
  /// `edge_length`. `treatments` become those of the triangles of the result.
  TriangleSurface
  thin(const TriangleSurface &surface, double edge_length, std::vector<Treatment> &treatments);

  /// Treatment of sheets that almost touch, as the lips of a mouth do, and that intersect when each
  /// is remeshed by itself.
  enum class NearSheets
  {
    held,   ///< their triangles stay as they are, so that the number of triangles hardly changes
    refined ///< all edges become shorter, so that triangles there are better
  };

  /// A gap that is to stay open: a place on the surface beside it, and its middle, which is
  /// outside.
  struct OpenGap
  {
    SpaceVector place, middle;
  };

  /// Whether remesh() with edges of this length, or twice as long, keeps edges that are sharp.
  bool
  has_sharp_edges(const TriangleSurface &surface, double edge_length);

  /// Remeshes a surface by remesh(), again and again, with edges of one length and another. The
  /// order of the shells is kept, and there are no intersections: where some come up, triangles are
  /// held (NearSheets::held), and once held they are held ever after, so that the number of
  /// triangles depends on the length of the edges alone, and smoothly; or edges become shorter. If
  /// one way does not help, the other one is tried. So gaps stay open, if they can.
  class SheetRemeshing
  {
  public:
    /// Keeps a reference to `cells_option`, the option by which the user asks for more cells.
    SheetRemeshing(const TriangleSurface      &surface,
                   bool                        keep_edges,
                   NearSheets                  near_sheets,
                   const std::vector<OpenGap> &gaps,
                   const std::string          &cells_option);

    /// Throws SolverFailure if there are intersections whatever is done.
    TriangleSurface
    remesh(double edge_length);

    /// Whether some triangles were held or edges had to be shorter.
    bool
    has_near_sheets() const
    {
      return met_sheets;
    }

  private:
    TriangleSurface
    remesh_in_order(double edge_length);
    std::vector<bool>
    are_open(const TriangleSurface &remeshed) const;
    void
    give_up_closed_gaps(const TriangleSurface &remeshed);
    bool
    mark_closed_gaps(const TriangleSurface &remeshed,
                     double                 distance,
                     std::vector<bool>     &marked) const;
    void
    thin_held(double edge_length);
    bool
    hold(TriangleSurface &result, double edge_length);
    bool
    refine(TriangleSurface &result, double edge_length);

    TriangleSurface      surface; ///< with its held triangles thinned
    const bool           keep_edges;
    const NearSheets     near_sheets;
    std::vector<OpenGap> gaps; ///< those that are not given up
    const std::string   &cells_option;
    std::vector<bool>    held;
    std::vector<bool>    is_thinned; ///< triangles that were thinned, or cannot be
    unsigned int         n_remeshed = 0;
    double               shortening = 1.; ///< factor of the edges' length
    bool                 met_sheets = false;
  };
} // namespace Exemplar

#endif
