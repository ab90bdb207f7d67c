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
  /// What statistics.csv says of a run as a whole; NaN where it says nothing.
  struct RunStatistics
  {
    double steps      = std::numeric_limits<double>::quiet_NaN(); ///< that were accepted
    double iterations = std::numeric_limits<double>::quiet_NaN();
    double residual   = std::numeric_limits<double>::quiet_NaN(); ///< the greatest
    double kkt        = std::numeric_limits<double>::quiet_NaN(); ///< the greatest of the weights'
    double min_det_F  = std::numeric_limits<double>::quiet_NaN();
    double energy     = std::numeric_limits<double>::quiet_NaN(); ///< in total, at the end [J]
    /// The greatest energy over all steps that neither was there at first nor was done as
    /// work, over the greatest of what was there at first and the work [-].
    double energy_growth = std::numeric_limits<double>::quiet_NaN();
    /// By how much a step in which handles rest misses the bound of implicit Euler at most,
    /// Psi_(n+1) + |v_(n+1) - v_n|^2_M/2 <= Psi_n + |v_n|^2_M/2 + work of loads, over the same
    /// scale [-]; negative if all are within. NaN where there is no such bound.
    double bound_excess = std::numeric_limits<double>::quiet_NaN();
  };

  /// What summary.json says of a run; NaN: nothing.
  struct RunSummary
  {
    double factorizations   = std::numeric_limits<double>::quiet_NaN();
    double condition_matrix = std::numeric_limits<double>::quiet_NaN(); ///< infinity: not definite
    double condition_schur  = std::numeric_limits<double>::quiet_NaN(); ///< infinity: not definite
    double peak_memory      = std::numeric_limits<double>::quiet_NaN(); ///< [MiB]
  };

  RunSummary
  read_run_summary(const std::filesystem::path &file);

  /// Of a run in this directory; without statistics.csv all is empty.
  RunStatistics
  read_run_statistics(const std::filesystem::path &file);

  /// The values of columns of statistics.csv in its last row; NaN where there are none.
  std::vector<double>
  read_last_values(const std::filesystem::path &file, const std::vector<std::string> &columns);

  /// Distances between two poses of one body over the displacement of the reference.
  struct PoseErrors
  {
    double l2  = std::numeric_limits<double>::quiet_NaN(); ///< root mean square over the volume
    double max = std::numeric_limits<double>::quiet_NaN(); ///< greatest over greatest
  };

  /// The nodes are matched by their rest positions, so the mesh of the reference may also be a
  /// refinement of the other. NaN if it is neither.
  PoseErrors
  pose_errors(const FinalPose &pose, const FinalPose &reference);
} // namespace Exemplar

#endif
