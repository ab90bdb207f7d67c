// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_resume_checks_h
#define exemplar_resume_checks_h

#include <exemplar/run/output/checkpoint.h>
#include <exemplar/run/scene/scene_file.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

// Checks of whether a checkpoint belongs to a scene.

namespace Exemplar
{
  /// The text of every key in force, by its path.
  std::map<std::string, std::string>
  values_of(const SceneFile &scene);

  /// The SHA-256 of every input file.
  std::map<std::string, std::string>
  digests_of(const SceneFile &scene);

  /// SHA-256 of all data of a scene that determine its states: input files, and values except those
  /// that a resumed run may change.
  std::string
  digest_of(const SceneFile &scene, const std::map<std::string, std::string> &input_digests);

  /// Throws UserError unless `state`, from `file`, is that of `step` in the run whose latest
  /// checkpoint is `last`, and `statistics` begins with the rows up to the later of both.
  void
  check_kept_state(const Checkpoint            &state,
                   const std::filesystem::path &file,
                   unsigned int                 step,
                   const Checkpoint            &last,
                   const std::filesystem::path &statistics);

  /// Throws UserError if the checkpoint in `file` does not belong to this scene and its input
  /// files, is of no step of it, or holds a state of other sizes or one that is not finite. A
  /// resumed run may have another end and other output; all else must agree.
  void
  check_resumable(const Checkpoint                         &checkpoint,
                  const SceneFile                          &scene,
                  const std::map<std::string, std::string> &input_digests,
                  const Problem                            &problem,
                  const std::filesystem::path              &file);

  /// Result of check_editable(), which is check_resumable() for a run that may continue with
  /// another scene of the same kind, mesh and time steps. If the scene differs, the solver's memory
  /// is dropped from the checkpoint; if the weights' number or rule differs, they restart from
  /// those of the problem. `notes` are for the user.
  struct EditCheck
  {
    bool                     is_edited = false;
    std::vector<std::string> notes;
  };

  EditCheck
  check_editable(Checkpoint                               &checkpoint,
                 const SceneFile                          &scene,
                 const std::map<std::string, std::string> &input_digests,
                 const Problem                            &problem,
                 const std::filesystem::path              &file);

  /// Throws UserError unless `file`, statistics.csv, begins with the bytes that it had when the
  /// checkpoint was written.
  void
  check_statistics(const std::filesystem::path &file, const Checkpoint &checkpoint);
} // namespace Exemplar

#endif
