// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/confinement.h>
#include <exemplar/base/environment.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/mesh/geo_meshing.h>
#include <exemplar/mesh/gmsh_session.h>
#include <exemplar/mesh/msh_comment.h>
#include <exemplar/mesh/msh_file.h>

#include <gmsh.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <set>

namespace Exemplar
{
  namespace
  {
    using DimTags = std::vector<std::pair<int, int>>;

    /// Conversion of gmsh's mesh to what it would write to a file of version 2.2.
    class MeshTaking
    {
    public:
      MeshTaking()
      {
        gmsh::option::getNumber("Mesh.SaveAll", save_all);
        DimTags groups;
        gmsh::model::getPhysicalGroups(groups);
        save_all = groups.empty() ? 1. : save_all;
        take_names(groups);
        take_elements();
        take_nodes();
      }

      MshFile msh;

    private:
      void
      take_names(const DimTags &groups)
      {
        for (const auto &[dimension, tag] : groups)
        {
          std::string name;
          gmsh::model::getPhysicalName(dimension, std::abs(tag), name);
          if (!name.empty())
            msh.physical_names[{ dimension, std::abs(tag) }] = name;
        }
      }

      /// Take the elements by type, then by entity; an element of several groups is taken once for
      /// each.
      void
      take_elements()
      {
        for (int dimension = 0; dimension <= 3; ++dimension)
        {
          std::vector<int> types;
          DimTags          entities;
          gmsh::model::mesh::getElementTypes(types, dimension);
          gmsh::model::getEntities(entities, dimension);
          for (const int type : std::set<int>(types.begin(), types.end()))
            for (const auto &[ignored, entity] : entities)
              take_elements_of(type, entity, groups_of(dimension, entity));
        }
      }

      std::vector<int>
      groups_of(const int dimension, const int entity) const
      {
        std::vector<int> groups{ 0 };
        if (save_all == 0.)
          gmsh::model::getPhysicalGroupsForEntity(dimension, entity, groups);
        return groups;
      }

      void
      take_elements_of(const int type, const int entity, const std::vector<int> &groups)
      {
        std::vector<std::size_t> numbers, nodes;
        gmsh::model::mesh::getElementsByType(type, numbers, nodes, entity);
        const std::size_t n     = numbers.empty() ? 0 : nodes.size() / numbers.size();
        auto              begin = nodes.begin();
        for (std::size_t i = 0; i < numbers.size(); ++i, begin += static_cast<std::ptrdiff_t>(n))
          for (const int group : groups)
          {
            msh.elements.push_back({ msh.elements.size() + 1,
                                     static_cast<unsigned int>(type),
                                     std::abs(group),
                                     entity,
                                     { begin, begin + static_cast<std::ptrdiff_t>(n) } });
            if (group < 0)
              turn_over(msh.elements.back());
          }
      }

      /// Reverse the orientation of an element, as in groups of negative numbers.
      static void
      turn_over(MshElement &element)
      {
        if (element.type == MshElementType::triangle)
          std::swap(element.nodes[1], element.nodes[2]);
        if (element.type == MshElementType::line || element.type == MshElementType::tetrahedron)
          std::swap(element.nodes[0], element.nodes[1]);
      }

      /// Take the nodes that elements have, in gmsh's order.
      void
      take_nodes()
      {
        std::vector<std::size_t> tags;
        std::vector<double>      places, parameters;
        gmsh::model::mesh::getNodes(tags, places, parameters);
        std::size_t maximum = 0;
        for (const std::size_t tag : tags)
          maximum = std::max(maximum, tag);
        std::vector<char> is_used(maximum + 1);
        for (const MshElement &element : msh.elements)
          for (const std::size_t tag : element.nodes)
            is_used.at(tag) = 1;
        double scale = 1.;
        gmsh::option::getNumber("Mesh.ScalingFactor", scale);
        std::vector<std::size_t> index(maximum + 1);
        for (std::size_t i = 0; i < tags.size(); ++i)
          if (is_used[tags[i]] != 0)
          {
            index[tags[i]] = msh.nodes.size();
            msh.nodes.emplace_back(rounded(scale * places[3 * i]),
                                   rounded(scale * places[3 * i + 1]),
                                   rounded(scale * places[3 * i + 2]));
            msh.node_numbers.push_back(msh.nodes.size());
          }
        for (MshElement &element : msh.elements)
          for (std::size_t &node : element.nodes)
            node = index[node];
      }

      /// Round to the 16 digits of gmsh's files; with 17, a mesh would differ from that of gmsh
      /// itself.
      static double
      rounded(const double x)
      {
        char text[32];
        std::snprintf(text, sizeof(text), "%.16g", x);
        return std::strtod(text, nullptr);
      }

      double save_all = 0.;
    };

    void
    confine_or_refuse(const std::filesystem::path &directory, std::vector<std::string> &walls)
    {
      walls = confine_this_process({ directory });
      if (walls.empty())
        throw UserError("this kernel has neither seccomp nor Landlock, by which gmsh is kept from "
                        "running programs and writing files. If you trust the file, give "
                        "--allow-commands, or mesh it yourself (gmsh -3 FILE) and set Mesh/File to "
                        "the .msh.");
    }

    /// The .msh that gmsh makes of a script; empty if gmsh fails.
    std::string
    mesh_by_gmsh(const std::filesystem::path &script, const std::vector<std::string> &walls)
    {
      const GmshSession session;
      try
      {
        gmsh::option::setNumber("General.Terminal", 1.);
        gmsh::option::setNumber("General.AbortOnError", 0.); // report all errors
        gmsh::open(script.string());
        gmsh::model::mesh::generate(3);
        std::string error;
        gmsh::logger::getLastError(error);
        return error.empty() ? with_comment(msh_text(MeshTaking().msh), joined(walls, " ")) : "";
      }
      catch (const std::exception &)
      {
        throw;
      }
      catch (...) // gmsh's own error has nothing to say
      {
        return "";
      }
    }

    /// Mesh in the copied process.
    std::string
    mesh_here(const std::filesystem::path &script,
              const std::filesystem::path &directory,
              const Confinement            confinement)
    {
      std::vector<std::string> walls;
      if (chdir(directory.c_str()) != 0)
        throw UserError(directory.string() + " cannot be entered.");
      if (confinement == Confinement::kernel)
        confine_or_refuse(directory, walls);
      const OneOpenMPThread one_thread; // the copy has no other threads
      return mesh_by_gmsh(script, walls);
    }
  } // namespace

  std::string
  mesh_script(const std::filesystem::path &script,
              const std::filesystem::path &directory,
              const Confinement            confinement,
              const CopyTask              &task,
              CopyMessages                &messages)
  {
    return in_process_copy([&] { return mesh_here(script, directory, confinement); }, task,
                           &messages);
  }
} // namespace Exemplar
