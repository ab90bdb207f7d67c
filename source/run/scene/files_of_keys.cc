// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/body/grain_axes.h>
#include <exemplar/mesh/map_name.h>
#include <exemplar/run/scene/files_of_keys.h>
#include <exemplar/surface/files/numbered_files.h>

namespace Exemplar
{
  namespace
  {
    bool
    ends_with(const std::string &text, const std::string &end)
    {
      return text.size() >= end.size()
             && text.compare(text.size() - end.size(), end.size(), end) == 0;
    }

    /// The files of a sequence that are there.
    void
    append_sequence(const std::string &pattern, std::vector<std::filesystem::path> &files)
    {
      try
      {
        for (const std::filesystem::path &file : expand_patterns({ pattern }))
          files.push_back(file);
      }
      catch (const UserError &)
      {
        files.emplace_back(pattern); // who reads it says that nothing matches
      }
    }

    /// The files that a selection names.
    void
    append_files(const Selection                    &selection,
                 const std::string                  &key,
                 std::vector<std::filesystem::path> &files)
    {
      if (!selection.file().empty())
        files.emplace_back(selection.file());
      if (!selection.map().empty())
        files.emplace_back(split_map_name(selection.map(), key).file);
    }
  } // namespace

  void
  append_files(const DeclaredKey &key, std::vector<std::filesystem::path> &files)
  {
    const bool is_map = ends_with(key.key, " map") || ends_with(key.key, " maps");
    if (key.is_input_file)
      for (const std::string &file : split_trimmed(key.value, key.is_list ? ',' : '\n'))
        if (is_map && !file.empty())
          files.emplace_back(split_map_name(file, key.path()).file);
        else if (key.key == "Follow cache" && !file.empty())
          append_sequence(file, files);
        else
          files.emplace_back(file);
    else if (key.key == "Fibre direction")
    {
      if (const auto ends = split_fibre_ends(key.value, key.path()))
        for (const Selection &end : { ends->from, ends->to })
          append_files(end, key.path(), files);
    }
    else if (key.key == "Select")
      append_files(Selection{ key.value }, key.path(), files);
  }
} // namespace Exemplar
