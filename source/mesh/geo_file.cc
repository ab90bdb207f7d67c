// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/build_identity.h>
#include <exemplar/base/digest.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/kept_bytes.h>
#include <exemplar/base/private_directory.h>
#include <exemplar/mesh/geo_meshing.h>
#include <exemplar/mesh/geo_text.h>
#include <exemplar/mesh/gmsh_session.h>
#include <exemplar/mesh/mesh_generation.h>
#include <exemplar/mesh/msh_comment.h>

#include <algorithm>
#include <fstream>
#include <sstream>

// Meshing of .geo files by gmsh.

namespace Exemplar
{
  namespace fs = std::filesystem;

  namespace
  {
    /// Limits of gmsh [s, bytes]: far more than any mesh has taken, but finite.
    constexpr double      time_limit    = 600.;
    constexpr std::size_t message_limit = 16 << 20;

    /// gmsh's errors, or else the last lines of its output.
    std::string
    telling_lines(const std::string &output)
    {
      std::vector<std::string> lines, errors;
      std::istringstream       in(output);
      for (std::string line; std::getline(in, line);)
      {
        lines.push_back(line);
        if (line.rfind("Error", 0) == 0)
          errors.push_back(line);
      }
      const auto       &shown = errors.empty() ? lines : errors;
      const std::size_t n     = std::min<std::size_t>(shown.size(), 5);
      std::string       text;
      for (std::size_t i = shown.size() - n; i < shown.size(); ++i)
        text += "\n  " + shown[i];
      return text;
    }

    /// Input of gmsh for a .geo: a script that runs in a directory.
    struct Meshing
    {
      const fs::path &geo;       ///< for messages
      fs::path        script;    ///< the .geo, or the text generated from it
      fs::path        directory; ///< an empty one, or that of the generated text
      Confinement     confinement;
    };

    std::string
    mesh(const Meshing &meshing, CopyMessages &messages)
    {
      const std::string geo = meshing.geo.string();
      const CopyTask    task{ geo + ": gmsh",
                           "Is there a loop without end? If not, mesh it yourself (gmsh -3 " + geo
                               + ") and set Mesh/File to the .msh.",
                           time_limit };
      try
      {
        return mesh_script(meshing.script, meshing.directory, meshing.confinement, task, messages);
      }
      catch (const SolverFailure &failure) // the file is to blame
      {
        throw UserError(failure.what());
      }
      catch (const UserError &error)
      {
        throw UserError(geo + ": " + error.what());
      }
    }

    void
    require_mesh(const std::string &msh, const std::string &messages, const fs::path &geo)
    {
      if (msh.empty() || messages.find("Error ") != std::string::npos)
        throw UserError(geo.string() + ": gmsh could not mesh it:" + telling_lines(messages)
                        + (messages.find("only available with OpenCASCADE") < messages.size()
                               ? "\n  Write as its first line: SetFactory(\"OpenCASCADE\");"
                               : "")
                        + "\n  Try it with: gmsh -3 " + geo.string());
    }

    void
    write_copy(const fs::path &file, const std::string &bytes)
    {
      std::ofstream out(file, std::ios::binary);
      out << bytes << std::flush;
      if (!out)
        throw UserError(file.string() + ": cannot be written; is the disk full? Set TMPDIR to a "
                        "directory with more room.");
    }

    std::string
    mesh_text(const GeoText &text, const fs::path &geo)
    {
      const PrivateDirectory directory;
      for (const auto &[name, bytes] : text.data)
        write_copy(directory.path() / name, bytes);
      const fs::path script = directory.path() / "script.geo";
      write_copy(script, text.script);
      CopyMessages      messages{ message_limit };
      const std::string msh
          = mesh({ geo, script, directory.path(), Confinement::kernel }, messages);
      require_mesh(msh, text.with_origins(messages.text, script.string()), geo);
      return msh;
    }

    std::string
    mesh_with_commands(const fs::path &geo)
    {
      const PrivateDirectory directory;
      CopyMessages           messages{ message_limit };
      const std::string      msh
          = mesh({ geo, fs::absolute(geo), directory.path(), Confinement::none }, messages);
      require_mesh(msh, messages.text, geo);
      return msh;
    }

    /// Restrictions in force: "text", followed by those that the comment names.
    std::vector<std::string>
    walls_around(const std::string &msh)
    {
      std::vector<std::string> walls{ "text" };
      std::istringstream       words(comment_of(msh));
      for (std::string wall; words >> wall;)
        walls.push_back(wall);
      return walls;
    }
  } // namespace

  MshFile
  mesh_geo_file(const fs::path &geo, const bool allow_commands)
  {
    const std::string name = geo.string();
    if (allow_commands)
    {
      MshFile msh   = read_msh_bytes(mesh_with_commands(geo), name);
      msh.geo_walls = std::vector<std::string>();
      return msh;
    }
    const GeoText     text = make_geo_text(geo);
    const std::string key
        = sha256_of_text(text.digest() + "\n" + gmsh_identity() + "\n" + own_build_identity());
    const KeptBytes kept = kept_bytes(key + ".msh", [&] { return mesh_text(text, geo); });
    MshFile         msh  = read_msh_bytes(kept.bytes, name);
    msh.note             = kept.warning;
    msh.geo_walls        = walls_around(kept.bytes);
    return msh;
  }
} // namespace Exemplar
