// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_resume_checks_h
#define exemplar_resume_checks_h

#include <exemplar/run/output/checkpoint.h>
#include <exemplar/run/scene/scene_file.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

// By what a checkpoint knows the scene that it belongs to.

namespace Exemplar
{
  /// The text of every key in force, by its path.
  std::map<std::string, std::string>
  values_of(const SceneFile &scene);

  /// The SHA-256 of every input file.
  std::map<std::string, std::string>
  digests_of(const SceneFile &scene);

  /// SHA-256 of all of a scene that its states follow from: its values, without those that a resumed run
  /// may change, and its input files.
  std::string
  digest_of(const SceneFile &scene, const std::map<std::string, std::string> &input_digests);

  /// Throws UserError unless `state`, which was kept in `file`, is that of `step` in the run that has
  /// left `last`, its latest checkpoint, and unless `statistics` begins with the rows up to the later of
  /// both.
  void
  check_kept_state(const Checkpoint            &state,
                   const std::filesystem::path &file,
                   unsigned int                 step,
                   const Checkpoint            &last,
                   const std::filesystem::path &statistics);

  /// Throws UserError if the checkpoint in `file` is none of this scene and its input files, does
  /// not stand at a step of it, or holds a state that is none of its problem: of other sizes, or
  /// not finite. A resumed run may end later and write differently; all else must be the same.
  void
  check_resumable(const Checkpoint                         &checkpoint,
                  const SceneFile                          &scene,
                  const std::map<std::string, std::string> &input_digests,
                  const Problem                            &problem,
                  const std::filesystem::path              &file);

  /// The same for a run that may go on with another scene: of the same kind, mesh and steps of time.
  /// If the scene is another one, what the solver remembered is dropped from the checkpoint, and so
  /// are weights that the scene does not have: it gets those that the problem begins with. Returns
  /// whether it is, and what the user must know of it.
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
