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
  /// A scene as text. It fills SceneParameters, completed and checked, and knows the text of
  /// each value in force.
  class SceneFile
  {
  public:
    /// Read a scene and the command line's overrides ("Section/Key=value"). Throws
    /// UserError.
    SceneFile(const std::filesystem::path &file, const std::vector<std::string> &overrides);

    /// The same from the text of a scene, as if `file` contained it. If `file` is empty, names
    /// of input files stay as they are.
    SceneFile(const std::filesystem::path    &file,
              const std::string              &text,
              const std::vector<std::string> &overrides);

    /// The same, with overrides that know their places.
    SceneFile(const std::filesystem::path   &file,
              const std::string             &text,
              const std::vector<Assignment> &overrides);

    SceneFile(const SceneFile &) = delete;
    SceneFile &
    operator=(const SceneFile &)
        = delete;

    /// The file of the scene, as it was given.
    const std::filesystem::path &
    get_path() const
    {
      return file;
    }

    /// Byte for byte.
    const std::string &
    get_text() const
    {
      return text;
    }

    /// What the text and the overrides say, with the defaults of all else.
    const CompleteScene &
    get_parameters() const
    {
      return *complete;
    }

    /// All keys with the values in force; input files are absolute.
    std::vector<DeclaredKey>
    get_keys() const;

    /// The input files that the scene needs.
    std::vector<std::filesystem::path>
    input_files() const;

    /// All files that the scene names, also those that it has no use for.
    std::vector<std::filesystem::path>
    named_files() const;

    /// All keys with their defaults, and one sample of each named subsection.
    static std::vector<DeclaredKey>
    reference();

  private:
    SceneFile() = default;

    /// From which input files are named; empty: they stay as they are.
    std::filesystem::path
    directory() const;

    void
    declare_sections();

    void
    declare_named_subsections(const std::vector<Assignment> &assignments);

    /// The line that should set Names says better what is wrong than the subsections that Names lacks.
    void
    refuse_misspelt_names(const std::vector<Assignment> &unknown);

    void
    make_selections_absolute();

    /// Take over as text what an interpolation has decided. Throws UserError where
    /// `assignments` have set another value, which is in `given`.
    void
    set_interpolation(const std::vector<Assignment> &assignments);

    const std::filesystem::path  file;
    const std::string            text;
    SceneParameters              parameters; ///< as the text says, where `auto` stays
    std::optional<CompleteScene> complete;
    KeyTable                     keys; ///< bound to `parameters` and the names
    std::vector<std::string>     handle_names;
    std::vector<std::string>     load_names;
  };
} // namespace Exemplar

#endif
