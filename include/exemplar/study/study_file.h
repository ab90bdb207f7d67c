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
  /// Contents of a study file: a scene, and the settings of its runs.
  struct Study
  {
    /// Read the file and check it as far as possible without the scene. Throws UserError.
    explicit Study(const std::filesystem::path &file);

    /// The choices on the axes for every run, the first axis slowest.
    std::vector<std::vector<unsigned int>>
    choices() const;

    /// The settings of a run in addition to the scene.
    std::vector<Assignment>
    assignments(const std::vector<unsigned int> &choice) const;

    /// The settings of the reference run in addition to the scene.
    std::vector<Assignment>
    reference_assignments() const;

    std::filesystem::path   file;
    std::string             text;  ///< of the file, byte for byte
    std::filesystem::path   scene; ///< absolute
    std::vector<Assignment> base;
    std::vector<Assignment> reference; ///< empty: no reference
    std::vector<StudyAxis>  axes;
    std::string             scene_place, vary_place;
    unsigned int            repeats = 3;
    double                  timeout = 0.; ///< [s], 0: none
    unsigned int            threads = 1;
    /// Columns of statistics.csv whose last values are columns of the table.
    std::vector<std::string> columns;
    std::string              columns_place;
    /// Point whose displacement at the end [m] is a column; none: no such column.
    std::optional<dealii::Point<3>> probe;
    std::string                     probe_place; ///< its place in the file, and its text
  };

  /// All keys of a study file, for the reference.
  std::vector<DeclaredKey>
  study_keys();
} // namespace Exemplar

#endif
