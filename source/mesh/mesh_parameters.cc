// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/mesh/mesh_parameters.h>
#include <exemplar/prm/key_table.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <set>

namespace Exemplar
{
  namespace
  {
    const EnumTable<MeshGenerator> generator_names{ { MeshGenerator::none, "none" },
                                                    { MeshGenerator::box, "box" } };

    const EnumTable<MeshKind> kind_names{ { MeshKind::solid, "solid" },
                                          { MeshKind::shell, "shell" } };

    bool
    may_name_frames(const char c)
    {
      return std::isalnum(static_cast<unsigned char>(c)) || static_cast<unsigned char>(c) >= 0x80
             || c == '_' || c == '-' || c == '.' || c == ' ';
    }
  } // namespace

  void
  MeshParameters::declare(KeyTable &keys)
  {
    keys.enter_subsection("Mesh");
    keys.add(
        "Kind", kind, kind_names,
        "solid: tetrahedra, or what fills a surface with them; shell: the triangles of File, a "
        "surface (.obj, .ply, .stl) or a .msh, which have Material/Thickness.");
    keys.add_file(
        "File", file,
        "The tetrahedral rest mesh: .msh (gmsh 2.2 or 4.1, ASCII or binary), .mesh (Medit), .vtk, "
        ".vtu, .node or .ele (TetGen), .inp (Abaqus, CalculiX: sets become regions, "
        "boundaries and node sets), .usda (TetMesh), .bdf or .nas (Nastran), or a .geo file, which "
        "gmsh meshes (the result "
        "is kept in "
        "~/.cache/exemplar); one that could run programs or write files is refused, "
        "unless the command line says --allow-commands. Physical Volumes give material "
        "ids, Physical "
        "Surfaces boundary ids. Or a surface, .obj, .ply or .stl, which is filled with "
        "cells as by exemplar mesh (kept there, too; the mesh is written to the output "
        "as rest.msh). Leave it empty if Generator = box.");
    keys.add_files(
        "Files", files,
        "Several meshes in one scene instead of File, without common nodes. Each may have "
        "a subsection Mesh/NAME that is called after its file, without directory and "
        "extension; a file that is named again is NAME 2. Nodes, elements and physical "
        "tags of the second file are numbered from the next power of ten on, of the third "
        "from twice that; a group of a file is 'NAME GROUP', and its region NAME, if it "
        "has one alone. A pose of one of the files is one in which the others are at "
        "rest.");
    keys.add("Cells", n_cells,
             "How many tetrahedra a surface is filled with, about, if File is one.",
             Bounds{ min_n_cells, max_n_cells });
    keys.add("Repair", repair,
             "Whether a surface that File names is mended before: holes, turned and intersecting "
             "faces; what cannot be mended is wrapped.");
    keys.add_file("Surface", surface,
                  "The surface inside of which the mesh was made: .obj, .ply or .stl, in the "
                  "mesh's unit and axes. Poses that are surfaces are poses of it, and formats of "
                  "Output/Formats that show surfaces write it as the body carries it. Empty: File, "
                  "if that is a surface.");
    keys.add_files(
        "Carry", carried,
        "Surfaces that go along with the body, inside, on or outside of it, such as eyes "
        "or a coat: .obj, .ply or .stl, in the mesh's unit and axes, each with frames of "
        "its own in all formats of Output/Formats, which are called after its file. They "
        "have no weight and no stiffness.");
    keys.add("Generator", generator, generator_names,
             "box: generate a box instead of reading a file. It spans 0..Lx, -Ly/2..Ly/2, "
             "-Lz/2..Lz/2, in bricks of 6 tetrahedra each; nodes are numbered from 1, x "
             "fastest; boundary ids are 1, 2, 3, 4, 5, 6 for x-, x+, y-, y+, z-, z+; the "
             "material id is 1.");
    keys.add("Box size", box_size,
             "Lengths Lx, Ly, Lz of the generated box [m before Scale], each > 0. It goes from x = "
             "0 to Lx and lies symmetric to y = 0 and z = 0.",
             Bounds{ 0. });
    keys.add("Box cells", box_cells,
             "Numbers of bricks of the generated box along x, y, z, each >= 1; every "
             "brick has 6 tetrahedra.",
             Bounds{ 1 });
    keys.add("Scale", scale,
             "Factor > 0 that makes metres of the coordinates of the mesh and of its "
             "poses, e.g. 0.001 for millimetres. All other lengths are in metres; poses "
             "are written in the mesh's own unit.",
             Bounds{ 0. });
    keys.leave_subsection();
  }

  void
  PlacedFile::declare(KeyTable &keys)
  {
    keys.enter_subsection(name);
    keys.add("Scale", scale,
             "Factor > 0 of the coordinates of this file of Mesh/Files, beside Mesh/Scale.",
             Bounds{ 0. });
    keys.add("Displacement", displacement,
             "Where the origin of this file of Mesh/Files lies, in the unit that Mesh/Scale makes "
             "metres of.");
    keys.leave_subsection();
  }

  std::vector<std::string>
  MeshParameters::names_of_files() const
  {
    std::vector<std::string>            names;
    std::map<std::string, unsigned int> n_of_file;
    for (const std::string &path : files)
    {
      if (is_surface_file(path))
        throw UserError("Mesh/Files: " + path + " is a surface. "
                        + (kind == MeshKind::shell
                               ? "A shell is one surface: name it in Mesh/File."
                               : "Fill it with cells, exemplar mesh --surface " + path
                                     + " --cells N --output FILE.msh, and name the .msh."));
      if (std::filesystem::path(path).extension() == ".geo")
        throw UserError("Mesh/Files: " + path + " is a geometry. Mesh it, gmsh -3 " + path
                        + ", and name the .msh.");
      const unsigned int n    = ++n_of_file[path];
      std::string        name = std::filesystem::path(path).stem().string();
      if (n > 1)
        name += " " + std::to_string(n);
      if (path.empty())
        throw UserError("Mesh/Files: between two commas there must be a file.");
      if (!std::all_of(name.begin(), name.end(), may_name_frames))
        throw UserError("Mesh/Files: groups and subsections are called after " + path
                        + ", so its name must consist of letters, digits, spaces, dots and the "
                          "signs _ and -. Rename the file.");
      if (std::find(names.begin(), names.end(), name) != names.end())
        throw UserError(
            "Mesh/Files: two files are called " + name
            + ", but groups and subsections are called after them. Rename one of them.");
      names.push_back(name);
    }
    return names;
  }

  std::string
  MeshParameters::name() const
  {
    if (generator == MeshGenerator::box)
      return "box";
    std::string all;
    for (const std::string &one : files)
      all += (all.empty() ? "" : " + ") + one;
    if (!all.empty())
      return all;
    return file.empty() ? "mesh" : file;
  }

  std::string
  MeshParameters::surface_file() const
  {
    return surface.empty() && is_surface_file(file) ? file : surface;
  }

  void
  MeshParameters::check_carried() const
  {
    std::set<std::string> names;
    for (const std::string &file : carried)
    {
      const std::string name = name_of_carried(file);
      if (!is_surface_file(file))
        throw UserError("Mesh/Carry: " + file
                        + " is no surface. Give files that end in .obj, .ply or .stl.");
      if (!std::all_of(name.begin(), name.end(), may_name_frames))
        throw UserError("Mesh/Carry: frames are called after " + file
                        + ", so its name must consist of letters, digits, spaces, dots and the "
                          "signs _ and -. Rename the file.");
      if (!names.insert(name).second)
        throw UserError("Mesh/Carry: two files are called " + name
                        + ", but frames are called after them. Rename one of them.");
    }
  }

  bool
  MeshParameters::is_surface() const
  {
    return kind == MeshKind::solid && is_surface_file(file);
  }

  bool
  is_surface_file(const std::string &file)
  {
    std::string extension = std::filesystem::path(file).extension().string();
    for (char &c : extension)
      c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension == ".obj" || extension == ".ply" || extension == ".stl";
  }

  std::string
  name_of_carried(const std::string &file)
  {
    return std::filesystem::path(file).stem().string();
  }
} // namespace Exemplar
