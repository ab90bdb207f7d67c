// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/number_text.h>
#include <exemplar/base/text_file.h>
#include <exemplar/base/words.h>
#include <exemplar/mesh/mesh_inputs.h>
#include <exemplar/surface/filling/cell_angles.h>
#include <exemplar/surface/filling/surface_msh.h>
#include <exemplar/surface/shape/surface_edges.h>
#include <exemplar/surface/shape/surface_geometry.h>
#include <exemplar/surface/shape/vectors.h>

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace Exemplar
{
  namespace
  {
    using Vertex = SurfaceMesh::Vertex;

    constexpr unsigned int largest_id = 1000000000;

    template <typename Number>
    bool
    parse(const std::string &text, Number &number)
    {
      const char *const end  = text.data() + text.size();
      const auto        done = std::from_chars(text.data(), end, number);
      return done.ec == std::errc() && done.ptr == end;
    }

    [[noreturn]] void
    fail(const std::filesystem::path &file, const std::size_t line, const std::string &message)
    {
      throw UserError(fmt::format("{}, line {}: {}", file.string(), line, message));
    }

    MaterialSeed
    read_row(const std::filesystem::path    &file,
             const std::size_t               line,
             const std::vector<std::string> &cells)
    {
      MaterialSeed seed{ {}, 0, cells.size() > 4 ? cells[4] : "", line };
      if (cells.size() < 4 || cells.size() > 5)
        fail(file, line,
             fmt::format("expected x,y,z,id or x,y,z,id,name, found {} columns.", cells.size()));
      for (unsigned int d = 0; d < 3; ++d)
        if (!parse(cells[d], seed.place[d]) || !std::isfinite(seed.place[d]))
          fail(file, line, "expected a coordinate, found " + in_quotes(cells[d]) + ".");
      if (!parse(cells[3], seed.id) || seed.id == 0 || seed.id > largest_id)
        fail(file, line,
             fmt::format("expected a material id, a whole number from 1 to {}, found {}.",
                         largest_id, in_quotes(cells[3])));
      if (seed.name.find('"') != std::string::npos)
        fail(file, line, "the name " + in_quotes(seed.name) + " holds a quote. Leave it out.");
      return seed;
    }

    bool
    is_inside(const std::array<SpaceVector, 4> &p, const SpaceVector &x)
    {
      const double size = six_volumes(p[0], p[1], p[2], p[3]);
      for (unsigned int k = 0; k < 4; ++k)
      {
        auto corners = p;
        corners[k]   = x;
        if (six_volumes(corners[0], corners[1], corners[2], corners[3]) < -1e-9 * size)
          return false;
      }
      return true;
    }

    unsigned int
    region_at(const TetrahedralMesh       &mesh,
              const MaterialSeed          &seed,
              const std::filesystem::path &file)
    {
      for (std::size_t c = 0; c < mesh.cells.size(); ++c)
        if (is_inside(corners_of(mesh, c), seed.place))
          return mesh.regions[c];
      fail(file, seed.line,
           "the point (" + short_text(seed.place[0]) + ", " + short_text(seed.place[1]) + ", "
               + short_text(seed.place[2])
               + ") is not inside the body. Move it inside; its unit is that of the surface.");
    }

    double
    square_distance(const std::array<SpaceVector, 4> &corners, const Vertex &place)
    {
      double sum = 0.;
      for (unsigned int d = 0; d < 3; ++d)
      {
        const double centre = (corners[0][d] + corners[1][d] + corners[2][d] + corners[3][d]) / 4.;
        sum += (centre - place[d]) * (centre - place[d]);
      }
      return sum;
    }

    /// The seeds in each region.
    using RegionSeeds = std::map<unsigned int, std::vector<const MaterialSeed *>>;

    RegionSeeds
    seeds_by_region(const TetrahedralMesh           &mesh,
                    const std::vector<MaterialSeed> &seeds,
                    const std::filesystem::path     &file)
    {
      RegionSeeds in_region;
      for (const MaterialSeed &seed : seeds)
        in_region[region_at(mesh, seed, file)].push_back(&seed);
      return in_region;
    }

    /// Ids of the regions that have no seed: the smallest that are left.
    std::map<unsigned int, unsigned int>
    ids_left(const TetrahedralMesh        &mesh,
             const std::set<unsigned int> &taken,
             const RegionSeeds            &in_region)
    {
      std::map<unsigned int, unsigned int> ids;
      unsigned int                         next = 1;
      for (const unsigned int region :
           std::set<unsigned int>(mesh.regions.begin(), mesh.regions.end()))
        if (in_region.count(region) == 0)
        {
          while (taken.count(next) > 0)
            ++next;
          ids[region] = next++;
        }
      return ids;
    }

    /// Names that are all whole numbers are ids; others get theirs in order, from 1.
    std::vector<unsigned int>
    ids_of(const std::vector<std::string> &names)
    {
      std::vector<unsigned int> ids, in_order;
      for (const std::string &name : names)
      {
        unsigned int id  = 0;
        const char  *end = name.data() + name.size();
        in_order.push_back(static_cast<unsigned int>(in_order.size() + 1));
        const auto done = std::from_chars(name.data(), end, id);
        if (done.ec == std::errc() && done.ptr == end && id < 2000000000U)
          ids.push_back(id);
      }
      const std::set<unsigned int> distinct(ids.begin(), ids.end());
      return distinct.size() == names.size() ? ids : in_order;
    }

    /// Whether each triangle of the boundary has cells on one side only: others lie between
    /// regions.
    std::vector<bool>
    outer_triangles(const TetrahedralMesh &mesh)
    {
      using Triangle    = std::array<unsigned int, 3>;
      const auto sorted = [](Triangle t)
      {
        std::sort(t.begin(), t.end());
        return t;
      };
      std::map<Triangle, unsigned int> n_cells;
      for (const Triangle &t : mesh.boundary.triangles)
        n_cells[sorted(t)] = 0;
      for (const auto &c : mesh.cells)
        for (unsigned int k = 0; k < 4; ++k)
        {
          const auto found
              = n_cells.find(sorted({ { c[(k + 1) % 4], c[(k + 2) % 4], c[(k + 3) % 4] } }));
          if (found != n_cells.end())
            ++found->second;
        }
      std::vector<bool> outer;
      for (const Triangle &t : mesh.boundary.triangles)
        outer.push_back(n_cells[sorted(t)] == 1);
      return outer;
    }

    /// The group of all triangles of each shell that bounds a region from outside, in the order of
    /// the regions; none where a shell has several.
    std::vector<std::set<unsigned int>>
    groups_around_regions(const TetrahedralMesh &mesh)
    {
      TriangleSurface surface = mesh.boundary;
      surface.vertices        = mesh.nodes;
      std::vector<unsigned int> shells;
      const unsigned int        n_shells = number_shells(surface, sorted_sides(surface), shells);
      std::vector<std::set<unsigned int>> groups;
      for (unsigned int shell = 0; shell < n_shells; ++shell)
        if (const TriangleSurface part = shell_of(surface, shells, shell);
            enclosed_volume(part) > 0.)
          groups.emplace_back(part.groups.begin(), part.groups.end());
      return groups;
    }
  } // namespace

  std::vector<MaterialSeed>
  read_material_seeds(const std::filesystem::path &file)
  {
    std::string reason;
    const auto  text = read_text_file(file, &reason);
    if (!text)
      throw UserError(file.string() + ": cannot be opened (" + reason
                      + "). Give a table of materials, with the header x,y,z,id,name.");
    std::vector<MaterialSeed>           seeds;
    std::map<unsigned int, std::string> names;
    std::size_t                         line   = 0;
    bool                                headed = false;
    for (const std::string &row : split_trimmed(*text, '\n'))
    {
      ++line;
      if (row.empty() || row[0] == '#')
        continue;
      const std::vector<std::string> cells = split_trimmed(row, ',');
      if (!headed)
      {
        if (row != "x,y,z,id" && row != "x,y,z,id,name")
          fail(file, line,
               "expected the header x,y,z,id or x,y,z,id,name, found " + in_quotes(row) + "."
                   + (row.find_first_of(";\t") < row.size() ? " Columns are separated by commas."
                                                            : ""));
        headed = true;
        continue;
      }
      seeds.push_back(read_row(file, line, cells));
      const auto &seed  = seeds.back();
      const auto  named = names.emplace(seed.id, seed.name);
      if (named.first->second != seed.name)
        fail(file, line,
             fmt::format("material {} is called {}, before {}. Give it one name.", seed.id,
                         in_quotes(seed.name), in_quotes(named.first->second)));
    }
    if (seeds.empty())
      throw UserError(file.string()
                      + ": there is no row. Give a point for each material: x,y,z,id,name.");
    return seeds;
  }

  Materials
  materials_by_seeds(const TetrahedralMesh           &mesh,
                     const std::vector<MaterialSeed> &seeds,
                     const std::vector<std::string>  &region_names,
                     const std::filesystem::path     &file)
  {
    const auto             in_region = seeds_by_region(mesh, seeds, file);
    std::set<unsigned int> taken;
    for (const MaterialSeed &seed : seeds)
      taken.insert(seed.id);
    const auto             left = ids_left(mesh, taken, in_region);
    Materials              result;
    std::set<unsigned int> used;
    for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    {
      const unsigned int region = mesh.regions[c];
      if (const auto found = left.find(region); found != left.end())
      {
        result.of_cell.push_back(found->second);
        result.names[found->second] = region_names[region];
        continue;
      }
      const MaterialSeed *nearest = nullptr;
      double              minimum = std::numeric_limits<double>::infinity();
      for (const MaterialSeed *seed : in_region.at(region))
        if (const double distance = square_distance(corners_of(mesh, c), seed->place);
            distance < minimum)
        {
          minimum = distance;
          nearest = seed;
        }
      result.of_cell.push_back(nearest->id);
      result.names[nearest->id] = nearest->name;
      used.insert(nearest->id);
    }
    for (const MaterialSeed &seed : seeds)
      if (used.count(seed.id) == 0)
        fail(file, seed.line,
             fmt::format("no cell is nearer to this point than to others, so material {} has none. "
                         "Take more cells, or fewer points.",
                         seed.id));
    return result;
  }

  std::vector<std::string>
  names_of_regions(const TetrahedralMesh &mesh, const std::vector<std::string> &group_names)
  {
    const auto                          groups = groups_around_regions(mesh);
    std::map<std::string, unsigned int> n_regions;
    std::vector<std::string>            names;
    for (const auto &around : groups)
    {
      const bool has_name = around.size() == 1 && *around.begin() < group_names.size();
      names.push_back(has_name ? group_names[*around.begin()] : "");
      ++n_regions[names.back()];
    }
    for (std::size_t region = 0; region < names.size(); ++region)
      if (names.size() == 1)
        names[region] = "body";
      else if (names[region].empty() || n_regions[names[region]] > 1)
        names[region] = fmt::format("shell {}", region + 1);
    return names;
  }

  Materials
  materials_by_regions(const TetrahedralMesh &mesh, const std::vector<std::string> &region_names)
  {
    const std::vector<unsigned int> ids = ids_of(region_names);
    Materials                       materials;
    for (const unsigned int region : mesh.regions)
    {
      materials.of_cell.push_back(ids[region]);
      materials.names[ids[region]] = region_names[region];
    }
    return materials;
  }

  MshFile
  make_surface_msh(const TetrahedralMesh          &mesh,
                   const std::vector<std::string> &group_names,
                   const Materials                &materials)
  {
    const auto names = group_names.empty() ? std::vector<std::string>{ "surface" } : group_names;
    const auto ids   = ids_of(names);
    std::vector<dealii::Point<3>> nodes;
    for (const auto &node : mesh.nodes)
      nodes.emplace_back(node[0], node[1], node[2]);
    std::vector<BoundaryFace> faces;
    const std::vector<bool>   outer = outer_triangles(mesh);
    for (std::size_t t = 0; t < mesh.boundary.triangles.size(); ++t)
      if (outer[t])
        faces.push_back({ mesh.boundary.triangles[t], ids[mesh.boundary.groups[t]] });
    MshFile msh = make_msh(std::move(nodes), mesh.cells, materials.of_cell, faces);
    for (std::size_t i = 0; i < names.size(); ++i)
      if (ids[i] > 0 && !names[i].empty())
        msh.physical_names[{ 2, static_cast<int>(ids[i]) }] = names[i];
    for (const auto &[id, name] : materials.names)
      if (id > 0 && !name.empty())
        msh.physical_names[{ 3, static_cast<int>(id) }] = name;
    return msh;
  }
} // namespace Exemplar
