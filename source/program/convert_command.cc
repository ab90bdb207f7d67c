// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/missing_file.h>
#include <exemplar/base/standard_streams.h>
#include <exemplar/base/words.h>
#include <exemplar/mesh/mesh.h>
#include <exemplar/mesh/mesh_file.h>
#include <exemplar/program/commands.h>

#include <iostream>

namespace Exemplar
{
  namespace fs = std::filesystem;

  void
  convert_mesh(const ConvertOptions &options)
  {
    require_file(options.input, "a mesh (" + mesh_extensions + ")");
    std::error_code ignored;
    if (fs::equivalent(options.input, options.output, ignored))
      throw UserError("IN and OUT are both " + options.output.string()
                      + ". Give the result another name.");
    const fs::path directory = fs::absolute(options.output).parent_path();
    if (!fs::is_directory(directory))
      throw UserError("OUT: there is no directory " + directory.string()
                      + ". Make it, or write elsewhere.");
    if (fs::exists(options.output, ignored))
      throw UserError(
          options.output.string()
          + " is there already and may hold work of yours. Remove it, or give another name.");
    const MshFile msh = read_mesh_file(options.input);
    std::string   note;
    try
    {
      note = write_mesh_file(msh, options.output);
    }
    catch (const UserError &error)
    {
      throw UserError(options.input.string() + ": " + error.what());
    }
    for (const std::string &one : { msh.note, note })
      if (!one.empty())
        std::cout << message_text(one) << '\n';
    std::cout << counted(msh.nodes.size(), "node") << " and "
              << counted(msh.elements.size(), "element") << ", written to "
              << message_text(options.output.string()) << '\n';
    require_printed();
  }
} // namespace Exemplar
