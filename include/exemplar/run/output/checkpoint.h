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
  /// Where a run went on with another scene.
  struct SceneEdit
  {
    unsigned int step;   ///< the last one of the scene before
    std::string  before; ///< the file that holds it, original_N.prm
    std::string  scene;  ///< digest_of() the scene that goes on
  };

  /// Totals over all steps, for the summary.
  struct RunTotals
  {
    unsigned int iterations     = 0;
    unsigned int factorizations = 0;
    double       worst_residual = 0.;
    PhaseSeconds seconds{};

    // by these a state is known as one of this run
    std::string            first_scene; ///< digest_of() the scene with which the run began
    std::vector<SceneEdit> edits;       ///< in order
  };

  /// A state on disk, of the last step or of a frame that is kept: what a resumed run needs to end in the same bytes as one that was never stopped. Rotations
  /// and matrices are not here, because they follow from the state and from what the step solver
  /// remembers.
  struct Checkpoint
  {
    std::map<std::string, std::string> parameters;    ///< key path -> value
    std::map<std::string, std::string> input_digests; ///< input file -> SHA-256
    State                              state;
    std::string                        solver_memory; ///< Problem::solver_memory()
    Work                               work;
    RunTotals                          totals;
    std::uintmax_t                     statistics_bytes = 0; ///< of statistics.csv at this state
    std::string                        statistics_digest;    ///< SHA-256 of these
  };

  /// Atomic: a kill at any moment leaves the checkpoint before or the new one.
  void
  save_checkpoint(const Checkpoint &checkpoint, const std::filesystem::path &file);

  /// Throws UserError if there is none, or if a single byte is not as save_checkpoint() of this
  /// version has written it.
  Checkpoint
  load_checkpoint(const std::filesystem::path &file);

  /// The root's to all processes that share a body.
  void
  share(const Exchange &exchange, Checkpoint &checkpoint);

  /// Put the problem where the checkpoint of that file, of a whole body, was saved. Throws UserError if what its
  /// solver remembered cannot be read.
  void
  restore(const Checkpoint &checkpoint, const std::filesystem::path &file, Problem &problem);
} // namespace Exemplar

#endif
