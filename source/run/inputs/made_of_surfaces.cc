// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/number_text.h>
#include <exemplar/base/words.h>
#include <exemplar/run/inputs/made_of_surfaces.h>

#include <fmt/core.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    /// Distance of a pose's boundary from its surface, relative to the diagonal, above which we
    /// warn.
    constexpr double tolerable_error = .02;

    std::string
    percent(const double share)
    {
      return short_text(100. * share) + " %";
    }

    std::string
    value_of(const MeshingReport &report, const std::string &what)
    {
      const auto found = std::find_if(report.table.begin(), report.table.end(),
                                      [&](const auto &entry) { return entry.first == what; });
      return found == report.table.end() ? "?" : found->second;
    }
  } // namespace

  std::vector<std::string>
  lines_of(const MadeOfSurfaces &made)
  {
    std::vector<std::string> lines = made.mesh.notes;
    const auto               value = [&](const char *what) { return value_of(made.mesh, what); };
    if (!made.mesh.table.empty())
      lines.push_back("made of the surface: smallest angles from " + value("angle_smallest")
                      + ", median " + value("angle_median") + " degrees; "
                      + value("surface_to_mesh_max") + " % of the diagonal from it at most, "
                      + value("surface_to_mesh_mean") + " % on average");
    for (const MadeOfSurfaces::Pose &pose : made.poses)
      lines.push_back(
          fmt::format("{}: {}, det F from {} to {}; {} from the surface at most, {} on average",
                      pose.file, counted(pose.quality.n_inverted, "inverted cell"),
                      short_text(pose.quality.min_det), short_text(pose.quality.max_det),
                      percent(pose.quality.max_error), percent(pose.quality.mean_error)));
    return lines;
  }

  std::vector<std::string>
  warnings_of(const MadeOfSurfaces &made)
  {
    std::vector<std::string> warnings = made.warnings;
    for (const MadeOfSurfaces::Pose &pose : made.poses)
      for (const std::string &warning :
           { pose.quality.warning_of_motion(), pose.quality.warning_of_edge() })
        if (!warning.empty())
          warnings.push_back(pose.file + ": " + warning);
    for (const MadeOfSurfaces::Pose &pose : made.poses)
      if (pose.quality.max_error > tolerable_error)
        warnings.push_back(pose.file + ": the mesh is up to " + percent(pose.quality.max_error)
                           + " of its diagonal away from this surface ("
                           + percent(pose.quality.mean_error)
                           + " on average). Where the surface folds or passes through itself "
                             "there, a stronger Examples/Attach follows it more closely and "
                             "strains the cells more; elsewhere, as at the corners of a mouth, "
                             "more cells do (Mesh/Cells).");
    return warnings;
  }
} // namespace Exemplar
