// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_checkpoint_h
#define exemplar_checkpoint_h

#include <exemplar/body/state.h>
#include <exemplar/run/output/diagnostics.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace Exemplar
{
  /// A change of the scene at a resume.
  struct SceneEdit
  {
    unsigned int step;   ///< the last step of the scene before
    std::string  before; ///< the copy of that scene, original_N.prm
    std::string  scene;  ///< digest_of() the scene after
  };

  /// Totals over all steps, for the summary.
  struct RunTotals
  {
    unsigned int iterations     = 0;
    unsigned int factorizations = 0;
    double       worst_residual = 0.;
    PhaseSeconds seconds{};

    // history of scenes, which tells whether a state is one of this run
    std::string            first_scene; ///< digest_of() the scene with which the run began
    std::vector<SceneEdit> edits;       ///< in order
  };

  /// A state on disk, of the last step or of a kept frame: all data with which a resumed run ends
  /// in the same bytes as one that was never stopped. Rotations and matrices follow from the state
  /// and the step solver's memory.
  struct Checkpoint
  {
    std::map<std::string, std::string> parameters;    ///< key path -> value
    std::map<std::string, std::string> input_digests; ///< input file -> SHA-256
    State                              state;
    std::string                        solver_memory; ///< Problem::solver_memory()
    Work                               work;
    RunTotals                          totals;
    std::uintmax_t                     statistics_bytes = 0; ///< of statistics.csv at this state
    std::string                        statistics_digest;    ///< SHA-256 of these bytes
  };

  /// Atomic: a kill at any moment leaves the checkpoint before or the new one.
  void
  save_checkpoint(const Checkpoint &checkpoint, const std::filesystem::path &file);

  /// Throws UserError if there is none, or if a single byte is not as save_checkpoint() of this
  /// version has written it.
  Checkpoint
  load_checkpoint(const std::filesystem::path &file);

  /// Broadcast the root's checkpoint to all processes that share a body.
  void
  share(const Exchange &exchange, Checkpoint &checkpoint);

  /// Set the problem to the checkpoint in `file`, which is of a whole body. Throws UserError if the
  /// solver's memory cannot be read.
  void
  restore(const Checkpoint &checkpoint, const std::filesystem::path &file, Problem &problem);
} // namespace Exemplar

#endif
