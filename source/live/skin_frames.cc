// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/live/skin_frames.h>
#include <exemplar/surface/shape/surface_mesh.h>
#include <exemplar/surface/skin/surface_skin.h>

#include <algorithm>
#include <cmath>

namespace Exemplar::Live
{
  namespace
  {
    /// A surface and its skin.
    struct Drawn
    {
      std::string        name; ///< empty: the body's
      const SurfaceMesh *surface;
      SurfaceSkin        skin;
    };

    /// All surfaces as the coefficients of their vertices, one after the other.
    struct Coefficients
    {
      std::vector<float>         offsets; ///< three a vertex [m]
      std::vector<std::uint32_t> ends;    ///< end of each vertex's part of the next two
      std::vector<std::uint32_t> nodes;
      std::vector<float>         values;
      std::vector<std::uint32_t> triangles;

      void
      add(const Drawn &drawn, const Mesh &mesh)
      {
        const auto first = static_cast<std::uint32_t>(ends.size());
        for (std::size_t v = 0; v < drawn.surface->vertices.size(); ++v)
        {
          // the nodes' places at rest are taken off here, so that viewers need not know them
          dealii::Point<3> offset = drawn.skin.place_at_rest(v);
          for (const NodalSum::Share &share : drawn.skin.shares_of(v))
          {
            offset -= share.coefficient * (mesh.get_nodes()[share.node] - dealii::Point<3>());
            nodes.push_back(share.node);
            values.push_back(static_cast<float>(share.coefficient));
          }
          for (unsigned int c = 0; c < 3; ++c)
            offsets.push_back(static_cast<float>(offset[c]));
          ends.push_back(static_cast<std::uint32_t>(nodes.size()));
        }
        for (const auto &face : drawn.surface->faces)
          for (std::size_t k = 2; k < face.size(); ++k)
            for (const unsigned int corner : { face[0], face[k - 1], face[k] })
              triangles.push_back(first + corner);
      }
    };

    std::vector<Drawn>
    surfaces_of(const Problem &problem, std::shared_ptr<const SurfaceMesh> &own)
    {
      const std::string  file = problem.parameters.mesh.surface_file();
      std::vector<Drawn> all;
      if (file.empty())
        return all;
      own = problem.body.surface != nullptr
                ? problem.body.surface
                : std::make_shared<const SurfaceMesh>(read_surface(file));
      all.push_back({ "", own.get(), SurfaceSkin(*own, problem.body.mesh, file) });
      for (const CarriedSurface &carried : problem.body.carried)
        all.push_back({ carried.name, &carried.surface,
                        skin_of_carried(carried.surface, problem.body.mesh, carried.name) });
      return all;
    }

    /// For each vertex the boundary's vertex that moves it most, of which it has the colour; `n_boundary`: none does.
    std::vector<std::uint32_t>
    nearest_of(const Coefficients &all, const std::uint32_t n_boundary)
    {
      std::vector<std::uint32_t> nearest;
      std::size_t                i = 0;
      for (const std::uint32_t end : all.ends)
      {
        std::uint32_t found = n_boundary;
        for (float most = 0.; i < end; ++i)
          if (all.nodes[i] < n_boundary && std::abs(all.values[i]) > most)
          {
            most  = std::abs(all.values[i]);
            found = all.nodes[i];
          }
        nearest.push_back(found);
      }
      return nearest;
    }

    template <typename Number>
    void
    append(std::string &bytes, const std::vector<Number> &numbers)
    {
      bytes.append(reinterpret_cast<const char *>(numbers.data()), numbers.size() * sizeof(Number));
    }
  } // namespace

  SkinFrames::SkinFrames(const Problem &problem, const BodySurface &boundary)
  {
    std::shared_ptr<const SurfaceMesh> own;
    const std::vector<Drawn>           all = surfaces_of(problem, own);
    if (all.empty())
      return;
    Coefficients coefficients;
    for (const Drawn &drawn : all)
    {
      coefficients.add(drawn, problem.body.mesh);
      surfaces.push_back({ drawn.name, drawn.surface->vertices.size() });
    }

    // number nodes as frames have them: those of the boundary, then the others
    const auto is_of_boundary = [&](const unsigned int node)
    { return std::binary_search(boundary.nodes.begin(), boundary.nodes.end(), node); };
    inner.nodes.assign(coefficients.nodes.begin(), coefficients.nodes.end());
    std::sort(inner.nodes.begin(), inner.nodes.end());
    inner.nodes.erase(std::unique(inner.nodes.begin(), inner.nodes.end()), inner.nodes.end());
    inner.nodes.erase(std::remove_if(inner.nodes.begin(), inner.nodes.end(), is_of_boundary),
                      inner.nodes.end());
    const auto n_boundary = static_cast<std::uint32_t>(boundary.nodes.size());
    const auto place_in   = [](const std::vector<unsigned int> &nodes, const unsigned int node)
    {
      return static_cast<std::uint32_t>(std::lower_bound(nodes.begin(), nodes.end(), node)
                                        - nodes.begin());
    };
    for (std::uint32_t &node : coefficients.nodes)
      node = is_of_boundary(node) ? place_in(boundary.nodes, node)
                                  : n_boundary + place_in(inner.nodes, node);

    append(bytes_of_topology, std::vector<std::uint32_t>{
                                  static_cast<std::uint32_t>(coefficients.ends.size()),
                                  static_cast<std::uint32_t>(coefficients.triangles.size() / 3),
                                  static_cast<std::uint32_t>(coefficients.nodes.size()) });
    append(bytes_of_topology, coefficients.offsets);
    append(bytes_of_topology, coefficients.ends);
    append(bytes_of_topology, nearest_of(coefficients, n_boundary));
    append(bytes_of_topology, coefficients.nodes);
    append(bytes_of_topology, coefficients.values);
    append(bytes_of_topology, coefficients.triangles);
  }

  Bytes
  SkinFrames::beside(const Bytes &frame, const Vector &positions) const
  {
    if (inner.nodes.empty())
      return frame;
    return std::make_shared<const std::string>(
        *frame + *frame_message({ BinaryKind::inner_nodes }, inner, positions));
  }
} // namespace Exemplar::Live
