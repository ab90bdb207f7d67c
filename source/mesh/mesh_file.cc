// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/missing_file.h>
#include <exemplar/base/text_file.h>
#include <exemplar/mesh/foreign_formats.h>
#include <exemplar/mesh/format_readers.h>
#include <exemplar/mesh/mesh_file.h>
#include <exemplar/mesh/mesh_text.h>
#include <exemplar/mesh/msh_nodes.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    namespace fs = std::filesystem;

    std::string
    bytes_of(const fs::path &file)
    {
      std::string reason;
      if (auto bytes = read_text_file(file, &reason))
        return std::move(*bytes);
      throw UserError(file.string() + ": cannot be opened (" + reason
                      + "). Give the path of a mesh (" + mesh_extensions + ")."
                      + missing_file_remedy(file));
    }

    /// The file beside with another extension, in the case of letters of the one given.
    fs::path
    beside(const fs::path &file, const std::string &extension)
    {
      const bool is_in_capitals
          = file.extension().string() == in_capitals(file.extension().string());
      return fs::path(file).replace_extension(is_in_capitals ? in_capitals(extension) : extension);
    }

    MshFile
    read_tetgen_files(const fs::path &file)
    {
      const fs::path nodes = beside(file, ".node"), cells = beside(file, ".ele"),
                     faces = beside(file, ".face");
      for (const fs::path &part : { nodes, cells })
        if (!fs::exists(part))
          throw UserError(file.string() + ": there is no such file as " + part.filename().string()
                          + " beside it. A mesh of TetGen is NAME.node and NAME.ele: copy both.");
      MshFile msh = read_tetgen(bytes_of(nodes), bytes_of(cells),
                                fs::exists(faces) ? bytes_of(faces) : std::string(), nodes);
      if (!fs::exists(faces))
        msh.note
            += (msh.note.empty() ? "" : " ") + nodes.string()
               + ": there is no .face beside, so that the mesh has no boundaries with numbers.";
      return msh;
    }

    struct Reader
    {
      const char *extension; ///< in capitals
      MshFile (*read)(std::string bytes, const std::string &name);
    };

    constexpr Reader readers[] = {
      { ".MESH", read_medit },  { ".VTK", read_legacy_vtk }, { ".VTU", read_vtu },
      { ".INP", read_abaqus },  { ".USDA", read_usd },       { ".BDF", read_nastran },
      { ".NAS", read_nastran },
    };

    const Reader *
    find_reader(const std::string &extension)
    {
      const auto *const found
          = std::find_if(std::begin(readers), std::end(readers),
                         [&](const Reader &reader) { return extension == reader.extension; });
      return found == std::end(readers) ? nullptr : found;
    }

    bool
    is_of_tetgen(const std::string &extension)
    {
      return extension == ".NODE" || extension == ".ELE";
    }
  } // namespace

  const std::string mesh_extensions
      = ".msh, .mesh, .vtk, .vtu, .node or .ele, .inp, .usda, .bdf or .nas";

  bool
  is_mesh_file(const fs::path &file)
  {
    const std::string extension = in_capitals(file.extension().string());
    return extension == ".MSH" || is_of_tetgen(extension) || find_reader(extension) != nullptr;
  }

  MshFile
  read_mesh_file(const fs::path &file)
  {
    const std::string extension = in_capitals(file.extension().string());
    if (is_of_tetgen(extension))
      return read_tetgen_files(file);
    const Reader *const reader = find_reader(extension);
    if (reader == nullptr)
    {
      MshFile msh = read_msh(file);
      drop_construction_points(msh, file.string());
      return msh;
    }
    std::string       bytes     = bytes_of(file);
    const std::string beginning = bytes.substr(0, 200);
    try
    {
      return reader->read(std::move(bytes), file.string());
    }
    catch (const UserError &error)
    {
      const std::string remedy = remedy_of_mesh(file, beginning);
      throw UserError(error.what() + (remedy.empty() ? "" : " " + remedy));
    }
  }
} // namespace Exemplar
