// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/mesh/mesh.h>
#include <exemplar/mesh/mesh_inputs.h>
#include <exemplar/mesh/rigid_motion.h>
#include <exemplar/surface/files/numbered_files.h>
#include <exemplar/surface/filling/cell_angles.h>
#include <exemplar/surface/making/parted_sheets.h>
#include <exemplar/surface/posing/pose_carrying.h>
#include <exemplar/surface/shape/narrow_gaps.h>
#include <exemplar/surface/shape/surface_checks.h>
#include <exemplar/surface/shape/surface_geometry.h>
#include <exemplar/surface/shape/triangle_surface.h>
#include <exemplar/surface/skin/surface_anchors.h>

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace Exemplar
{
  namespace
  {
    /// Faults that violate the preconditions of self_intersections().
    const std::vector<std::string> unsound
        = { "edges of more than two faces", "vertices where the surface touches itself",
            "faces turned against their neighbours", "one-sided" };

    std::vector<bool>
    unsound_triangles(const TriangleSurface &surface)
    {
      std::vector<bool> triangles(surface.triangles.size(), false);
      std::vector<bool> vertices(surface.vertices.size(), false);
      for (const FaultyElement &element : check_surface({ surface, {} }).elements)
        if (std::find(unsound.begin(), unsound.end(), element.fault) != unsound.end())
          (element.is_face ? triangles : vertices)[element.index] = true;
      for (std::size_t t = 0; t < triangles.size(); ++t)
        for (const unsigned int vertex : surface.triangles[t])
          triangles[t] = triangles[t] || vertices[vertex];
      return triangles;
    }

    /// Finds crossings between sheets of a surface, for any positions of its vertices.
    class SheetCrossings
    {
    public:
      /// Leaves out triangles that are faulty by themselves (edges of more than two triangles,
      /// turned triangles).
      explicit SheetCrossings(const TriangleSurface &surface);

      /// Pairs of triangles that cross, by their numbers in the surface.
      std::vector<std::pair<unsigned int, unsigned int>>
      pairs(const std::vector<SurfaceMesh::Vertex> &vertices) const;

    private:
      TriangleSurface           sound;   ///< the surface without faulty triangles
      std::vector<unsigned int> numbers; ///< of each triangle of `sound`, its number in the surface
    };

    SheetCrossings::SheetCrossings(const TriangleSurface &surface)
        : sound(surface), numbers(surface.triangles.size())
    {
      std::iota(numbers.begin(), numbers.end(), 0U);
      for (std::vector<bool> bad                                     = unsound_triangles(sound);
           std::find(bad.begin(), bad.end(), true) != bad.end(); bad = unsound_triangles(sound))
      {
        std::size_t n = 0;
        for (std::size_t t = 0; t < bad.size(); ++t)
          if (!bad[t])
          {
            sound.triangles[n] = sound.triangles[t];
            sound.groups[n]    = sound.groups[t];
            numbers[n++]       = numbers[t];
          }
        sound.triangles.resize(n);
        sound.groups.resize(n);
        numbers.resize(n);
      }
    }

    std::vector<std::pair<unsigned int, unsigned int>>
    SheetCrossings::pairs(const std::vector<SurfaceMesh::Vertex> &vertices) const
    {
      TriangleSurface placed = sound;
      placed.vertices        = vertices;
      auto found             = self_intersections(placed);
      for (auto &[a, b] : found)
      {
        a = numbers[a];
        b = numbers[b];
      }
      return found;
    }

    using Vertices = std::vector<SurfaceMesh::Vertex>;
    using Pairs    = std::vector<std::pair<unsigned int, unsigned int>>;
    using Points   = FoldPotential::Points;

    /// Shares of the way to a pose by which the surface is opened, ascending.
    constexpr std::array<double, 4> ways{ { .25, .5, .75, 1. } };

    /// Stiffness with which cells that are carried back to rest follow the surface, over their own;
    /// it is that large because this is the rest shape of the body, no pose of it.
    constexpr double attach_at_rest = 3000.;

    /// A pose, moved rigidly to where it is nearest to the surface at rest.
    struct NearPose
    {
      std::filesystem::path file;
      Vertices              vertices;
    };

    std::vector<NearPose>
    read_near_poses(const SurfaceMeshingOptions &options, const RestSurface &rest)
    {
      std::vector<std::string> entries;
      for (const auto &file : options.poses)
        entries.push_back(file.string());
      std::vector<NearPose> poses;
      for (const auto &file : expand_patterns(entries))
      {
        NearPose          pose{ file, read_pose_surface(file, rest).vertices };
        const RigidMotion back
            = best_rigid_motion(as_points(pose.vertices), as_points(rest.surface.vertices));
        for (auto &x : pose.vertices)
        {
          const auto moved = back(dealii::Point<3>(x[0], x[1], x[2]));
          x                = { { moved[0], moved[1], moved[2] } };
        }
        poses.push_back(std::move(pose));
      }
      return poses;
    }

    /// Positions of the surface's vertices, and the pairs of triangles that cross there.
    struct Opening
    {
      Vertices    vertices;
      Pairs       crossing;
      std::string how; ///< description for the user
    };

    Vertices
    on_the_way(const Vertices &from, const Vertices &rest, const Vertices &pose, const double way)
    {
      Vertices result = from;
      for (std::size_t v = 0; v < result.size(); ++v)
        result[v] = plus(from[v], way, minus(pose[v], rest[v]));
      return result;
    }

    /// The opening with one more pose added that leaves the fewest pairs crossing, by the smallest
    /// share of the way to it that does, and if it may be the next one, as sheets that have just
    /// parted almost touch; or `now` itself.
    Opening
    opened_further(const Opening               &now,
                   const Vertices              &rest,
                   const std::vector<NearPose> &poses,
                   const SheetCrossings        &crossings)
    {
      const auto opened = [&](const NearPose &pose, const double way)
      {
        Vertices vertices = on_the_way(now.vertices, rest, pose.vertices, way);
        Pairs    pairs    = crossings.pairs(vertices);
        return Opening{ std::move(vertices), std::move(pairs),
                        now.how
                            + fmt::format("{}{} % of the way to {}", now.how.empty() ? "" : " and ",
                                          100. * way, pose.file.filename().string()) };
      };
      Opening         best      = now;
      const NearPose *best_pose = nullptr;
      std::size_t     best_way  = 0;
      for (std::size_t k = 0; k < ways.size(); ++k)
        for (const NearPose &pose : poses)
          if (!best.crossing.empty())
            if (Opening next = opened(pose, ways[k]); next.crossing.size() < best.crossing.size())
            {
              best      = std::move(next);
              best_pose = &pose;
              best_way  = k;
            }
      if (best_pose != nullptr && best_way + 1 < ways.size())
        if (Opening next = opened(*best_pose, ways[best_way + 1]);
            next.crossing.size() <= best.crossing.size())
          return next;
      return best;
    }

    Opening
    find_opening(const Vertices              &rest,
                 const std::vector<NearPose> &poses,
                 const SheetCrossings        &crossings)
    {
      Opening now{ rest, crossings.pairs(rest), "" };
      for (std::size_t k = 0; k < poses.size() && !now.crossing.empty(); ++k)
      {
        Opening further = opened_further(now, rest, poses, crossings);
        if (further.how == now.how)
          break;
        now = std::move(further);
      }
      return now;
    }

    std::vector<std::string>
    notes_on(const Opening &opening, const TriangleSurface &rest, const Pairs &at_rest)
    {
      std::vector<std::string> notes;
      const auto               place = [&](const Pairs &pairs)
      {
        const unsigned int vertex = rest.triangles[pairs[0].first][0];
        const auto        &x      = rest.vertices[vertex];
        return fmt::format("the first at vertex {} ({}, {}, {})", vertex + 1, short_text(x[0]),
                           short_text(x[1]), short_text(x[2]));
      };
      if (!opening.how.empty())
        notes.push_back(fmt::format(
            "Sheets cross at rest ({} pairs of faces, {}): the body was filled {}, where {} "
            "pairs cross, and its cells brought back; they overlap at rest.",
            at_rest.size(), place(at_rest), opening.how, opening.crossing.size()));
      if (!opening.crossing.empty())
        notes.push_back(fmt::format(
            "{} pairs of faces cross at rest and in all poses ({}): they become one piece there, "
            "and poses that part them lose that. Give a pose in which they are apart (--poses).",
            opening.crossing.size(), place(opening.crossing)));
      return notes;
    }

    SpaceVector
    place_in(const TriangleSurface &surface, const SurfacePoint &point, const Vertices &vertices)
    {
      SpaceVector place{ { 0., 0., 0. } };
      for (int a = 0; a < 3; ++a)
        place = plus(place, point.share[a], vertices[surface.triangles[point.triangle][a]]);
      return place;
    }

    /// Gaps narrower than the cells whose sheets go apart or together by more than
    /// least_parting times the diagonal in a pose: if cells filled them, the sheets would hang
    /// together.
    std::vector<OpenGap>
    parting_gaps(const TriangleSurface       &placed,
                 const std::vector<NearPose> &poses,
                 const double                 n_cells)
    {
      constexpr double     least_parting = .003;
      const double         least         = least_parting * diagonal_of(placed.vertices);
      std::vector<OpenGap> result;
      for (const NarrowGap &gap : narrow_gaps(placed, edge_length_of(placed, n_cells)))
      {
        const auto width = [&](const Vertices &vertices) {
          return norm(
              minus(place_in(placed, gap.near, vertices), place_in(placed, gap.far, vertices)));
        };
        const double before = width(placed.vertices);
        if (std::any_of(poses.begin(), poses.end(),
                        [&](const NearPose &pose)
                        { return std::abs(width(pose.vertices) - before) > least; }))
          result.push_back({ place_in(placed, gap.near, placed.vertices), gap.middle });
      }
      return result;
    }

    std::vector<SurfaceTie>
    ties_where_open(const SurfaceMesh     &rest,
                    const Vertices        &vertices,
                    const TetrahedralMesh &filled)
    {
      SurfaceMesh open = rest;
      open.vertices    = vertices;
      return make_ties(open, Mesh(make_msh(as_points(filled.nodes), filled.cells), "the cells"));
    }

    /// Moves the cells that fill the surface at `from` to where they fill it at `to`.
    void
    carry_cells(TetrahedralMesh &mesh, const TriangleSurface &from, const Vertices &to)
    {
      const Points              nodes = as_points(mesh.nodes);
      std::vector<BoundaryFace> faces;
      for (const auto &triangle : mesh.boundary.triangles)
        faces.push_back({ triangle, 0 });
      PoseTransfer transfer(nodes, mesh.cells, SurfaceAttachment(nodes, faces, from),
                            attach_at_rest);
      PoseQuality  quality;
      const Points x = transfer.carry(to, quality);
      if (!(quality.min_det > FoldSolver::margin))
        throw SolverFailure("Cells stay inverted on their way from the pose in which sheets are "
                            "apart back to rest. Give a pose that is nearer to rest (--poses), or "
                            "ask for another number of cells.");
      for (std::size_t i = 0; i < x.size(); ++i)
        mesh.nodes[i] = { { x[i][0], x[i][1], x[i][2] } };
      remove_slivers(mesh, BoundaryNodes::kept); // sheets that touch must not cross
    }
  } // namespace

  bool
  has_crossing_sheets(const SurfaceMesh &surface)
  {
    return !SheetCrossings(triangulate(surface)).pairs(surface.vertices).empty();
  }

  MeshedSurface
  mesh_parted(const SurfaceMeshingOptions &options)
  {
    const RestSurface           rest(options.surface);
    const std::vector<NearPose> poses     = read_near_poses(options, rest);
    const TriangleSurface       triangles = triangulate(rest.surface);
    const SheetCrossings        crossings(triangles);
    const Opening               opening = find_opening(rest.surface.vertices, poses, crossings);
    TriangleSurface             open    = triangles;
    open.vertices                       = opening.vertices;
    const std::vector<OpenGap> gaps     = opening.crossing.empty()
                                              ? parting_gaps(open, poses, options.n_cells)
                                              : std::vector<OpenGap>{};
    if (opening.how.empty() && opening.crossing.empty())
      return mesh_surface_at(rest.surface, { rest.surface.vertices, {}, {}, gaps }, options);
    std::function<void(TetrahedralMesh &)> back;
    std::vector<SurfaceTie>                ties;
    if (!opening.how.empty())
      back = [&](TetrahedralMesh &mesh)
      {
        ties = ties_where_open(rest.surface, opening.vertices, mesh);
        carry_cells(mesh, open, rest.surface.vertices);
      };
    MeshedSurface meshed = mesh_surface_at(
        rest.surface,
        { opening.vertices, back,
          notes_on(opening, triangles, crossings.pairs(rest.surface.vertices)), gaps },
        options);
    meshed.mesh.surface_ties = std::move(ties);
    return meshed;
  }
} // namespace Exemplar
