// SPDX-License-Identifier: GPL-3.0-or-later What gmsh and meshio convert:
// https://gmsh.info/doc/texinfo/gmsh.html, https://github.com/nschloe/meshio
#include <exemplar/mesh/foreign_formats.h>
#include <exemplar/mesh/mesh_file.h>

#include <algorithm>
#include <cctype>
#include <vector>

namespace Exemplar
{
  namespace
  {
    enum class Way
    {
      gmsh,
      meshio,
      cad,
      scene_of_others,
      surface,
      readable_surface,
      packed,
      scene,
      geo,
      msh,
      data
    };

    struct Format
    {
      std::string              name;
      Way                      way;
      std::vector<std::string> extensions; ///< extensions in lower case
      std::vector<std::string> beginnings; ///< first bytes of such files; may be empty
    };

    const std::vector<Format> &
    formats()
    {
      static const std::vector<Format> all = {
        { "a legacy VTK file", Way::msh, { ".vtk" }, { "# vtk DataFile" } },
        { "an I-DEAS universal file", Way::gmsh, { ".unv" }, {} },
        { "a Nastran file", Way::msh, { ".bdf", ".nas" }, { "BEGIN BULK", "SOL " } },
        { "a Medit mesh", Way::msh, { ".mesh" }, { "MeshVersionFormatted" } },
        { "a binary Medit mesh", Way::gmsh, { ".meshb" }, {} },
        { "an Abaqus file", Way::msh, { ".inp" }, { "*HEADING", "*Heading", "*NODE", "*Node" } },
        { "a VTK XML file", Way::msh, { ".vtu" }, { "<VTKFile", "<?xml" } },
        { "a VTK XML file", Way::meshio, { ".vtp", ".pvd", ".pvtu" }, {} },
        { "an XDMF file", Way::meshio, { ".xdmf", ".xmf" }, {} },
        { "a mesh of TetGen", Way::msh, { ".node", ".ele" }, {} },
        { "a MED file", Way::meshio, { ".med" }, {} },
        { "an Exodus file", Way::meshio, { ".e", ".ex2", ".exo" }, {} },
        { "a CGNS file", Way::meshio, { ".cgns" }, {} },
        { "a mesh of SU2", Way::meshio, { ".su2" }, {} },
        { "a CAD model",
          Way::cad,
          { ".step", ".stp", ".iges", ".igs", ".brep" },
          { "ISO-10303-21" } },
        { "a file of Blender", Way::scene_of_others, { ".blend" }, { "BLENDER" } },
        { "an FBX file", Way::scene_of_others, { ".fbx" }, { "Kaydara FBX" } },
        { "an Alembic file", Way::scene_of_others, { ".abc" }, { "Ogawa" } },
        { "a glTF file", Way::scene_of_others, { ".gltf", ".glb" }, { "glTF" } },
        { "a USD file", Way::scene_of_others, { ".usd", ".usdc", ".usdz" }, { "PXR-USDC" } },
        { "a text of USD", Way::msh, { ".usda" }, { "#usda" } },
        { "a Collada file", Way::scene_of_others, { ".dae" }, {} },
        { "a file of Maya", Way::scene_of_others, { ".ma", ".mb" }, {} },
        { "a file of 3ds Max", Way::scene_of_others, { ".max", ".3ds" }, {} },
        { "a file of Houdini", Way::scene_of_others, { ".hip", ".bgeo", ".sc" }, {} },
        { "an OFF surface", Way::surface, { ".off" }, { "OFF" } },
        { "a 3MF file", Way::surface, { ".3mf" }, {} },
        { "a VRML file", Way::surface, { ".wrl", ".x3d" }, { "#VRML" } },
        { "a packed file",
          Way::packed,
          { ".gz", ".zip", ".xz", ".bz2", ".7z", ".zst" },
          { "\x1f\x8b", "PK\x03\x04",
            "\xfd"
            "7zXZ",
            "BZh" } },
        { "a file that git-lfs has not fetched", Way::packed, {}, { "version https://git-lfs" } },
        { "a web page", Way::packed, { ".html" }, { "<!DOCTYPE", "<html" } },
        { "an STL surface", Way::readable_surface, { ".stl" }, { "solid " } },
        { "a PLY surface", Way::readable_surface, { ".ply" }, { "ply\n", "ply\r\n" } },
        { "an OBJ surface",
          Way::readable_surface,
          { ".obj" },
          { "v ", "# Blender", "mtllib ", "o " } },
        { "a scene", Way::scene, { ".prm" }, { "set ", "subsection " } },
        { "a gmsh script", Way::geo, { ".geo" }, {} },
        { "a mesh of tetrahedra", Way::msh, { ".msh" }, { "$MeshFormat" } },
        { "a mesh of Ansys", Way::meshio, { ".msh" }, { "(0 ", "(1 " } },
        { "a JSON file", Way::data, { ".json" }, { "{", "[" } },
        { "an array of numpy", Way::data, { ".npy" }, { "\x93NUMPY" } },
        { "an archive of numpy's arrays", Way::data, { ".npz" }, {} },
        { "an HDF5 file", Way::data, { ".h5", ".hdf5", ".mat" }, {} },
        { "a table", Way::data, { ".csv", ".txt", ".dat" }, {} },
      };
      return all;
    }

    std::string
    extension_of(const std::filesystem::path &file)
    {
      std::string extension = file.extension().string();
      std::transform(extension.begin(), extension.end(), extension.begin(),
                     [](const unsigned char c) { return static_cast<char>(std::tolower(c)); });
      return extension;
    }

    template <typename Predicate>
    const Format *
    find_format(const Predicate &is_it)
    {
      const auto found = std::find_if(formats().begin(), formats().end(), is_it);
      return found == formats().end() ? nullptr : &*found;
    }

    const Format *
    format_of_name(const std::filesystem::path &file)
    {
      const std::string extension = extension_of(file);
      return find_format(
          [&](const Format &format) {
            return std::count(format.extensions.begin(), format.extensions.end(), extension) > 0;
          });
    }

    const Format *
    format_of_bytes(std::string_view bytes)
    {
      bytes.remove_prefix(
          std::min(bytes.find_first_not_of(" \t"), bytes.size())); // as gmsh begins a .mesh
      return find_format(
          [&](const Format &format)
          {
            return std::any_of(format.beginnings.begin(), format.beginnings.end(),
                               [&](const std::string &beginning)
                               { return bytes.substr(0, beginning.size()) == beginning; });
          });
    }

    /// The format of a file by its bytes; if these are only those of a zip archive or of XML, by
    /// its extension, provided that its format has no first bytes of its own.
    const Format *
    format_of(const std::filesystem::path &file, const std::string_view bytes)
    {
      const Format *const by_bytes = format_of_bytes(bytes), *const by_name = format_of_name(file);
      const bool is_within = bytes.substr(0, 2) == "PK" || bytes.substr(0, 5) == "<?xml";
      return by_bytes == nullptr || (is_within && by_name != nullptr && by_name->beginnings.empty())
                 ? by_name
                 : by_bytes;
    }

    std::string
    quoted(const std::string &name)
    {
      return name.find_first_of(" '&;()") == std::string::npos ? name : "\"" + name + "\"";
    }

    /// Shell commands that convert a file of this name into a mesh.
    std::string
    conversion(const Way way, const std::filesystem::path &file)
    {
      const std::string old = quoted(file.filename().string());
      const std::string made
          = quoted(file.stem().string() + (file.extension() == ".msh" ? "_2.msh" : ".msh"));
      const std::string by_meshio
          = "meshio convert " + old + " " + made + " --output-format gmsh22 (package meshio-tools)";
      switch (way)
      {
      case Way::gmsh:
        return "Convert it: gmsh " + old + " -save -format msh22 -o " + made;
      case Way::meshio:
        return "Convert it: " + by_meshio;
      case Way::cad:
        return "Mesh it: gmsh -3 " + old + " -format msh22 -o " + made
               + "; its lengths are mostly millimetres, of which Mesh/Scale = 0.001 makes metres";
      case Way::scene_of_others:
      case Way::surface:
        return "Export the object as .obj, .ply or .stl in the program that made it (Blender: "
               "File > Export > Wavefront); a closed surface is filled with cells by Mesh/File "
               "or exemplar mesh";
      case Way::readable_surface:
        return "Tetrahedra are made inside it by exemplar mesh, or by Mesh/File = " + old;
      case Way::packed:
        return "Unpack or fetch the file itself (gunzip, unzip, git lfs pull, or download it "
               "again)";
      case Way::scene:
        return "Name the mesh here, not the scene";
      case Way::geo:
        return "gmsh makes a mesh of it if its name ends in .geo, in small letters";
      case Way::data:
        return "Meshes are read from " + mesh_extensions
               + " and .geo, surfaces from .obj, .ply and "
                 ".stl. Arrays are taken from Python: exemplar.Problem(scene, mesh=(nodes, "
                 "cells)), "
                 "and meshio writes them as .msh: meshio.Mesh(nodes, [(\"tetra\", "
                 "cells)]).write(\""
               + file.stem().string() + ".msh\", file_format=\"gmsh22\")";
      default:
        return "";
      }
    }

    /// The file's name with an extension of its format, by which programs tell the format.
    std::filesystem::path
    with_right_name(const Format &format, std::filesystem::path file)
    {
      const std::vector<std::string> &endings = format.extensions;
      const bool is_right = std::count(endings.begin(), endings.end(), extension_of(file)) > 0;
      const bool matters  = format.way == Way::gmsh || format.way == Way::msh
                           || format.way == Way::cad || format.way == Way::meshio
                           || format.way == Way::readable_surface;
      return is_right || !matters ? file : file.replace_extension(endings[0]);
    }

    std::string
    remedy(const Format *const format, const std::filesystem::path &file)
    {
      if (format == nullptr)
        return "";
      const std::filesystem::path named = with_right_name(*format, file);
      return "It is " + format->name + ". "
             + (named == file ? "" : "Call it " + named.filename().string() + ". ")
             + conversion(format->way, named) + ".";
    }
  } // namespace

  std::string
  remedy_of_mesh(const std::filesystem::path &file, const std::string_view bytes)
  {
    const Format *const format = format_of(file, bytes);
    if (format == nullptr || format->way != Way::msh)
      return remedy(format, file);
    const std::filesystem::path named = with_right_name(*format, file);
    return named == file ? ""
                         : "It is " + format->name + ". Call it " + named.filename().string() + ".";
  }

  std::string
  remedy_of_surface(const std::filesystem::path &file, const std::string_view bytes)
  {
    const Format *const format = format_of(file, bytes);
    if (format == nullptr)
      return "";
    const std::string what = "It is " + format->name;
    const std::string name = with_right_name(*format, file).filename().string();
    switch (format->way)
    {
    case Way::gmsh:
    case Way::meshio:
      return what
             + ", not a surface that is read. If it holds a surface, write it as .ply in ParaView "
               "(open "
             + name
             + ", Filters > Extract Surface, File > Save Data). A mesh of tetrahedra needs no "
               "filling: Mesh/File names it, as .msh. "
             + conversion(format->way, name) + ".";
    case Way::msh:
      return what
             + ", not a surface. It needs no filling: a scene names it by Mesh/File or, if it is a "
               "pose, by Examples/Poses.";
    case Way::cad:
    case Way::geo:
      return what + ". Make a surface of it: gmsh -2 " + quoted(name) + " -o "
             + quoted(file.stem().string() + ".stl") + ".";
    case Way::data:
      return what + ", not a surface.";
    default:
      return remedy(format, file);
    }
  }

  std::string
  remedy_of_content(const std::filesystem::path &surface, const std::string_view bytes)
  {
    const Format *const format = format_of_bytes(bytes);
    if (format == nullptr || format == format_of_name(surface))
      return "";
    return remedy_of_surface(surface, bytes);
  }
} // namespace Exemplar
