// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/atomic_file.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/mesh/mesh_builder.h>
#include <exemplar/mesh/mesh_file.h>
#include <exemplar/mesh/mesh_text.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

namespace Exemplar
{
  namespace
  {
    namespace fs = std::filesystem;

    /// An element's type in gmsh and in the other formats.
    struct WrittenKind
    {
      unsigned int gmsh;
      int          vtk;
      const char  *medit, *abaqus;
    };

    constexpr std::array<WrittenKind, 7> written_kinds{
      { { MshElementType::point, 1, "", "" },
        { MshElementType::line, 3, "Edges", "T3D2" },
        { MshElementType::quadratic_line, 21, "EdgesP2", "T3D3" },
        { MshElementType::triangle, 5, "Triangles", "CPS3" },
        { MshElementType::quadratic_triangle, 22, "TrianglesP2", "CPS6" },
        { MshElementType::tetrahedron, 10, "Tetrahedra", "C3D4" },
        { MshElementType::quadratic_tetrahedron, 24, "TetrahedraP2", "C3D10" } }
    };

    const WrittenKind &
    kind_of_element(const MshElement &element)
    {
      for (const WrittenKind &kind : written_kinds)
        if (kind.gmsh == element.type)
          return kind;
      throw UserError(fmt::format("element {} is a {}, which is not written; lines, triangles and "
                                  "tetrahedra are. Mesh with tetrahedra.",
                                  element.number, find_msh_element_kind(element.type)->name));
    }

    using Text = fmt::memory_buffer;

    template <typename... Arguments>
    void
    append(Text &text, const char *const format, const Arguments &...arguments)
    {
      fmt::format_to(std::back_inserter(text), fmt::runtime(format), arguments...);
    }

    void
    append_place(Text &text, const dealii::Point<3> &x, const char *const gap)
    {
      append(text, "{:.17g}{}{:.17g}{}{:.17g}", x[0], gap, x[1], gap, x[2]);
    }

    std::vector<std::size_t>
    nodes_in_order(const MshElement &element)
    {
      std::vector<std::size_t> nodes = element.nodes;
      exchange_last_edges(nodes);
      return nodes;
    }

    bool
    is_counted_from_1(const MshFile &msh)
    {
      for (std::size_t i = 0; i < msh.nodes.size(); ++i)
        if (msh.node_numbers[i] != i + 1)
          return false;
      for (std::size_t i = 0; i < msh.elements.size(); ++i)
        if (msh.elements[i].number != i + 1)
          return false;
      return true;
    }

    /// What a format without numbers and names cannot hold.
    std::string
    lost_names(const MshFile &msh, const std::string &format)
    {
      std::string lost;
      if (!is_counted_from_1(msh))
        lost += " Nodes and elements are counted from 1, in their order.";
      if (!msh.physical_names.empty())
        lost += " Names of groups are left out; their numbers stay.";
      return lost.empty() ? "" : format + " has no place for some of the mesh." + lost;
    }

    std::string
    write_medit(const MshFile &msh, Text &text)
    {
      append(text, "MeshVersionFormatted 2\nDimension 3\nVertices\n{}\n", msh.nodes.size());
      for (const dealii::Point<3> &node : msh.nodes)
      {
        append_place(text, node, " ");
        append(text, " 0\n");
      }
      bool has_points = false;
      for (std::size_t begin = 0, end = 0; begin < msh.elements.size(); begin = end)
      {
        const WrittenKind &kind = kind_of_element(msh.elements[begin]);
        while (end < msh.elements.size() && msh.elements[end].type == kind.gmsh)
          ++end;
        if (kind.gmsh == MshElementType::point)
        {
          has_points = true;
          continue;
        }
        append(text, "{}\n{}\n", kind.medit, end - begin);
        for (std::size_t e = begin; e < end; ++e)
        {
          for (const std::size_t node : nodes_in_order(msh.elements[e]))
            append(text, "{} ", node + 1);
          append(text, "{}\n", std::abs(msh.elements[e].physical));
        }
      }
      append(text, "End\n");
      const std::string lost = lost_names(msh, "The format of Medit");
      return lost
             + (has_points ? (lost.empty() ? "" : " ") + std::string("Points are left out.") : "");
    }

    template <typename Entry>
    void
    append_array(Text &text, const std::string &attributes, const MshFile &msh, const Entry &entry)
    {
      append(text, "        <DataArray {} format=\"ascii\">\n", attributes);
      for (const MshElement &element : msh.elements)
      {
        entry(element);
        append(text, "\n");
      }
      append(text, "        </DataArray>\n");
    }

    std::string
    write_vtu(const MshFile &msh, Text &text)
    {
      append(text,
             "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" "
             "byte_order=\"LittleEndian\">\n  <UnstructuredGrid>\n    <Piece NumberOfPoints=\"{}\" "
             "NumberOfCells=\"{}\">\n      <Points>\n        <DataArray type=\"Float64\" "
             "Name=\"Points\" NumberOfComponents=\"3\" format=\"ascii\">\n",
             msh.nodes.size(), msh.elements.size());
      for (const dealii::Point<3> &node : msh.nodes)
      {
        append_place(text, node, " ");
        append(text, "\n");
      }
      append(text, "        </DataArray>\n      </Points>\n      <Cells>\n");
      append_array(text, "type=\"Int64\" Name=\"connectivity\"", msh,
                   [&](const MshElement &element)
                   {
                     for (const std::size_t node : nodes_in_order(element))
                       append(text, "{} ", node);
                   });
      std::size_t end = 0;
      append_array(text, "type=\"Int64\" Name=\"offsets\"", msh,
                   [&](const MshElement &element)
                   { append(text, "{}", end += element.nodes.size()); });
      append_array(text, "type=\"UInt8\" Name=\"types\"", msh,
                   [&](const MshElement &element)
                   { append(text, "{}", kind_of_element(element).vtk); });
      append(text, "      </Cells>\n      <CellData>\n");
      append_array(text, "type=\"Int32\" Name=\"gmsh:physical\"", msh,
                   [&](const MshElement &element)
                   { append(text, "{}", std::abs(element.physical)); });
      append_array(text, "type=\"Int32\" Name=\"gmsh:geometrical\"", msh,
                   [&](const MshElement &element)
                   { append(text, "{}", std::abs(element.elementary)); });
      append(text, "      </CellData>\n    </Piece>\n  </UnstructuredGrid>\n</VTKFile>\n");
      return lost_names(msh, "A .vtu");
    }

    /// The name of an element's set; empty for tag 0.
    std::string
    set_of_element(const MshFile &msh, const MshElement &element)
    {
      const auto dimension = static_cast<int>(find_msh_element_kind(element.type)->dimension);
      const auto named     = msh.physical_names.find({ dimension, element.physical });
      if (named == msh.physical_names.end())
        return element.physical == 0 ? ""
                                     : fmt::format("{}_{}", dimension == 3 ? "REGION" : "BOUNDARY",
                                                   std::abs(element.physical));
      if (named->second.find_first_of(",=\"*\r\n") != std::string::npos
          || named->second.size() > 80)
        throw UserError(
            "the group " + in_quotes(named->second)
            + " has a name that an .inp cannot hold: no comma, =, *, quotation mark, and "
              "at most 80 letters. Give it another name in the mesh.");
      return named->second;
    }

    void
    append_node_sets(const MshFile &msh, Text &text)
    {
      std::string before;
      for (const MshElement &element : msh.elements)
        if (element.type == MshElementType::point)
        {
          const std::string named = set_of_element(msh, element);
          const std::string set   = named.empty() ? "POINTS" : named;
          if (set != before)
            append(text, "*NSET, NSET={}\n", set);
          before = set;
          append(text, "{}\n", msh.node_numbers[element.nodes[0]]);
        }
    }

    std::string
    write_inp(const MshFile &msh, Text &text)
    {
      append(text, "*HEADING\n exemplar convert\n*NODE\n");
      for (std::size_t i = 0; i < msh.nodes.size(); ++i)
      {
        append(text, "{}, ", msh.node_numbers[i]);
        append_place(text, msh.nodes[i], ", ");
        append(text, "\n");
      }
      std::string before;
      for (const MshElement &element : msh.elements)
      {
        const WrittenKind &kind = kind_of_element(element);
        if (kind.gmsh == MshElementType::point)
          continue;
        const std::string set  = set_of_element(msh, element);
        const std::string head = fmt::format("*ELEMENT, TYPE={}{}{}\n", kind.abaqus,
                                             set.empty() ? "" : ", ELSET=", set);
        if (head != before)
          append(text, "{}", head);
        before = head;
        append(text, "{}", element.number);
        for (const std::size_t node : nodes_in_order(element))
          append(text, ", {}", msh.node_numbers[node]);
        append(text, "\n");
      }
      append_node_sets(msh, text);
      return msh.physical_names.empty() ? ""
                                        : "An .inp has names of groups instead of their numbers: "
                                          "groups with names are numbered by their order.";
    }
  } // namespace

  std::string
  write_mesh_file(const MshFile &msh, const fs::path &file)
  {
    const std::string extension = in_capitals(file.extension().string());
    Text              text;
    std::string       lost;
    if (extension == ".MSH")
    {
      write_msh(msh, file);
      return "";
    }
    if (extension == ".MESH")
      lost = write_medit(msh, text);
    else if (extension == ".VTU")
      lost = write_vtu(msh, text);
    else if (extension == ".INP")
      lost = write_inp(msh, text);
    else
      throw UserError(
          file.string()
          + ": meshes are written as .msh, .mesh, .vtu and .inp. Give a name that ends in "
            "one of them; meshio (package meshio-tools) converts a .vtu into others.");
    AtomicFile out(file);
    out.stream().write(text.data(), static_cast<std::streamsize>(text.size()));
    out.commit();
    return lost;
  }
} // namespace Exemplar
