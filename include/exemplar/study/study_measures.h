// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_study_measures_h
#define exemplar_study_measures_h

#include <exemplar/run/output/final_pose.h>

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace Exemplar
{
  /// Totals of a run from statistics.csv; NaN if unknown.
  struct RunStatistics
  {
    double steps      = std::numeric_limits<double>::quiet_NaN(); ///< number of accepted steps
    double iterations = std::numeric_limits<double>::quiet_NaN();
    double residual   = std::numeric_limits<double>::quiet_NaN(); ///< maximum over steps
    double kkt = std::numeric_limits<double>::quiet_NaN(); ///< maximum of the weights' KKT residual
    double min_det_F = std::numeric_limits<double>::quiet_NaN();
    double energy    = std::numeric_limits<double>::quiet_NaN(); ///< total at the end [J]
    /// Greatest total energy in excess of the initial energy and the work done, relative to the
    /// greatest magnitude of either [-].
    double energy_growth = std::numeric_limits<double>::quiet_NaN();
    /// Greatest excess of a step in which handles rest over the bound of implicit Euler, Psi_(n+1)
    /// + |v_(n+1) - v_n|^2_M/2 <= Psi_n + |v_n|^2_M/2 + work of loads, relative to the same scale
    /// [-]; negative if all steps satisfy it. NaN if the bound does not apply.
    double bound_excess = std::numeric_limits<double>::quiet_NaN();
  };

  /// Numbers of a run from summary.json; NaN if unknown.
  struct RunSummary
  {
    double factorizations   = std::numeric_limits<double>::quiet_NaN();
    double condition_matrix = std::numeric_limits<double>::quiet_NaN(); ///< infinity: not definite
    double condition_schur  = std::numeric_limits<double>::quiet_NaN(); ///< infinity: not definite
    double peak_memory      = std::numeric_limits<double>::quiet_NaN(); ///< [MiB]
  };

  RunSummary
  read_run_summary(const std::filesystem::path &file);

  /// The totals of a statistics.csv; all are NaN if it is missing.
  RunStatistics
  read_run_statistics(const std::filesystem::path &file);

  /// The values in the last row of columns of a statistics.csv; NaN if missing.
  std::vector<double>
  read_last_values(const std::filesystem::path &file, const std::vector<std::string> &columns);

  /// Distances between two poses of a body, relative to the displacement of the reference.
  struct PoseErrors
  {
    double l2  = std::numeric_limits<double>::quiet_NaN(); ///< root mean square over the volume
    double max = std::numeric_limits<double>::quiet_NaN(); ///< ratio of maxima
  };

  /// Nodes are matched by their rest positions, so that the reference's mesh may be the same or a
  /// refinement; NaN if it is neither.
  PoseErrors
  pose_errors(const FinalPose &pose, const FinalPose &reference);
} // namespace Exemplar

#endif
