// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/words.h>
#include <exemplar/body/grain_axes.h>
#include <exemplar/mesh/map_name.h>
#include <exemplar/obstacles/obstacle_shape.h>
#include <exemplar/run/scene/files_of_keys.h>
#include <exemplar/surface/files/numbered_files.h>

namespace Exemplar
{
  namespace
  {
    /// Append the names of the files that a selection reads.
    void
    append_names(const Selection          &selection,
                 const std::string        &key,
                 std::vector<std::string> &names)
    {
      if (!selection.file().empty())
        names.push_back(selection.file());
      if (!selection.map().empty())
        names.push_back(split_map_name(selection.map(), key).file);
    }
  } // namespace

  std::vector<std::string>
  file_names(const DeclaredKey &key)
  {
    const bool               is_map = ends_with(key.key, " map") || ends_with(key.key, " maps");
    std::vector<std::string> names;
    if (key.is_input_file)
      for (const std::string &file : split_trimmed(key.value, key.is_list ? ',' : '\n'))
        names.push_back(is_map && !file.empty() ? split_map_name(file, key.path()).file : file);
    else if (key.key == "Fibre direction")
    {
      if (const auto ends = split_fibre_ends(key.value, key.path()))
        for (const Selection &end : { ends->from, ends->to })
          append_names(end, key.path(), names);
    }
    else if (key.key == "Select" || key.key == "To")
      append_names(Selection{ key.value }, key.path(), names);
    else if (key.key == "Leave out")
      for (const std::string &text : split_trimmed(key.value, ';'))
        append_names(Selection{ text }, key.path(), names);
    else if (key.key == "Shape" && !file_of_shape(key.value).empty())
      names.push_back(file_of_shape(key.value));
    return names;
  }

  std::vector<std::filesystem::path>
  files_of_name(const DeclaredKey &key, const std::string &name)
  {
    if (key.key != "Follow cache" || name.empty())
      return { name };
    try
    {
      return expand_patterns({ name });
    }
    catch (const UserError &)
    {
      return { name }; // its reader reports that nothing matches
    }
  }

  void
  append_files(const DeclaredKey &key, std::vector<std::filesystem::path> &files)
  {
    for (const std::string &name : file_names(key))
      for (const std::filesystem::path &file : files_of_name(key, name))
        files.push_back(file);
  }
} // namespace Exemplar
