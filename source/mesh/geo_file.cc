// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/child_process.h>
#include <exemplar/base/digest.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/kept_file.h>
#include <exemplar/mesh/geo_script.h>
#include <exemplar/mesh/mesh_generation.h>

#include <algorithm>
#include <sstream>
#include <vector>

// Meshes that gmsh makes of .geo files, and the directory in which they are kept.

namespace Exemplar
{
  namespace fs = std::filesystem;

  namespace
  {
    /// What gmsh is allowed [s, bytes]: far more than any mesh has taken, but not for ever.
    constexpr double         time_limit   = 600.;
    constexpr std::uintmax_t output_limit = 16 << 20;

    /// gmsh's errors, or else the last lines that it wrote.
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

    std::string
    gmsh_version(const fs::path &geo)
    {
      const ChildOutput gmsh
          = output_of_child({ "gmsh", "--version" }, { "/", time_limit, output_limit });
      if (gmsh.end.exit_status == no_such_program)
        throw UserError(geo.string()
                        + ": meshing it needs gmsh, which cannot be started. Install "
                          "the package gmsh, or mesh it elsewhere and set Mesh/File "
                          "to the .msh.");
      return gmsh.text;
    }

    /// What to say of a gmsh that was ended; empty if it came to its own end.
    std::string
    why_ended(const ChildEnd &end)
    {
      if (end.signal == 0)
        return "";
      if (end.timed_out)
        return "gmsh did not come to an end within " + std::to_string(static_cast<int>(time_limit))
               + " s and was ended. Is there a loop without end? If not, mesh it";
      if (end.said_too_much)
        return "gmsh wrote more than " + std::to_string(output_limit >> 20)
               + " MiB of messages and was ended. Is there a loop without end? If not, mesh it";
      return "";
    }

    /// Have gmsh mesh a file, in the directory of the mesh that it is to make.
    void
    run_gmsh(const fs::path &geo, const fs::path &made)
    {
      // Absolute, so that no name is taken for an option, and names in it are found from there.
      const ChildOutput gmsh = output_of_child(
          { "gmsh", "-3", fs::absolute(geo).string(), "-format", "msh22", "-o", made.string() },
          { made.parent_path(), time_limit, output_limit });
      if (const std::string why = why_ended(gmsh.end); !why.empty())
        throw UserError(geo.string() + ": " + why + " yourself and set Mesh/File to the .msh.");
      const bool no_error = (gmsh.text.find("Error ") == std::string::npos);
      if (gmsh.end.exit_status != 0 || !no_error || !fs::exists(made))
        throw UserError(geo.string() + ": gmsh could not mesh it:" + telling_lines(gmsh.text)
                        + "\n  Try it with: gmsh -3 " + geo.string());
    }
  } // namespace

  fs::path
  mesh_geo_file(const fs::path &geo, const bool allow_commands)
  {
    // First: a missing file needs no gmsh. What a script with commands reads and does is not
    // known, so it is run each time.
    const GeoInputs   inputs = allow_commands ? GeoInputs{ sha256(geo), false } : check_geo(geo);
    const std::string key    = sha256_of_text(inputs.digests + gmsh_version(geo)
                                              + (inputs.all_known ? "" : fs::absolute(geo).string()));
    return kept_file(key + ".msh", !inputs.all_known,
                     [&](const fs::path &made) { run_gmsh(geo, made); });
  }
} // namespace Exemplar
