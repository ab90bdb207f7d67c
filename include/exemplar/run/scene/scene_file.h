// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_scene_file_h
#define exemplar_scene_file_h

#include <exemplar/prm/key_table.h>
#include <exemplar/run/scene/scene_parameters.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  /// A scene as text, and the SceneParameters of it, completed and checked. Knows the text of each
  /// value in force.
  class SceneFile
  {
  public:
    /// Read a scene and the command line's overrides ("Section/Key=value"). Throws
    /// UserError.
    SceneFile(const std::filesystem::path &file, const std::vector<std::string> &overrides);

    /// Read the text of a scene as if `file` contained it. If `file` is empty, names of input files
    /// are not resolved.
    SceneFile(const std::filesystem::path    &file,
              const std::string              &text,
              const std::vector<std::string> &overrides);

    /// Read the text of a scene with overrides that know their places.
    SceneFile(const std::filesystem::path   &file,
              const std::string             &text,
              const std::vector<Assignment> &overrides);

    SceneFile(const SceneFile &) = delete;
    SceneFile &
    operator=(const SceneFile &)
        = delete;

    /// The file of the scene, as given.
    const std::filesystem::path &
    get_path() const
    {
      return file;
    }

    /// The text of the scene, byte for byte.
    const std::string &
    get_text() const
    {
      return text;
    }

    /// The parameters by text and overrides, with defaults elsewhere.
    const CompleteScene &
    get_parameters() const
    {
      return *complete;
    }

    /// All keys with the values in force; input files have absolute paths.
    std::vector<DeclaredKey>
    get_keys() const;

    /// The input files that the scene needs.
    std::vector<std::filesystem::path>
    input_files() const;

    /// All files that the scene names, including those it does not use.
    std::vector<std::filesystem::path>
    named_files() const;

    /// All keys with their defaults, and one sample of each named subsection.
    static std::vector<DeclaredKey>
    reference();

  private:
    SceneFile() = default;

    /// The folder to which names of input files are relative; empty: they are not resolved.
    std::filesystem::path
    directory() const;

    void
    declare_sections();

    void
    declare_named_subsections(const std::vector<Assignment> &assignments);

    /// A misspelt key Names is reported rather than the subsections that it would have listed.
    void
    refuse_misspelt_names(const std::vector<Assignment> &unknown);

    void
    make_selections_absolute();

    /// Set the text of values that an interpolation determines. Throws UserError where
    /// `assignments` have set another value, which is in `given`.
    void
    set_interpolation(const std::vector<Assignment> &assignments);

    const std::filesystem::path  file;
    const std::string            text;
    SceneParameters              parameters; ///< as in the text, `auto` included
    std::optional<CompleteScene> complete;
    KeyTable                     keys; ///< bound to `parameters` and the names
    std::vector<std::string>     handle_names;
    std::vector<std::string>     load_names;
    std::vector<std::string>     obstacle_names;
    std::vector<std::string>     tie_names;
  };
} // namespace Exemplar

#endif
