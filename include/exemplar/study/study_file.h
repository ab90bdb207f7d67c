// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_study_file_h
#define exemplar_study_file_h

#include <exemplar/prm/key_table.h>
#include <exemplar/study/study_axes.h>

#include <deal.II/base/point.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  /// What a study file says: a scene, and the settings with which it is run.
  struct Study
  {
    /// Read the file and check what can be told without the scene. Throws UserError.
    explicit Study(const std::filesystem::path &file);

    /// The choices on the axes of every run, the first axis slowest.
    std::vector<std::vector<unsigned int>>
    choices() const;

    /// What a run sets beyond the scene.
    std::vector<Assignment>
    assignments(const std::vector<unsigned int> &choice) const;

    /// The same of the reference run.
    std::vector<Assignment>
    reference_assignments() const;

    std::filesystem::path   file;
    std::string             text;  ///< of the file, byte for byte
    std::filesystem::path   scene; ///< absolute
    std::vector<Assignment> base;
    std::vector<Assignment> reference; ///< empty: there is none
    std::vector<StudyAxis>  axes;
    std::string             scene_place, vary_place;
    unsigned int            repeats = 3;
    double                  timeout = 0.; ///< [s], 0: none
    unsigned int            threads = 1;
    /// Of statistics.csv; their values at the end are columns of the table.
    std::vector<std::string> columns;
    std::string              columns_place;
    /// Where the displacement at the end is a column [m].
    std::optional<dealii::Point<3>> probe;
    std::string                     probe_place; ///< and its text
  };

  /// All keys of a study file, for the reference.
  std::vector<DeclaredKey>
  study_keys();
} // namespace Exemplar

#endif
