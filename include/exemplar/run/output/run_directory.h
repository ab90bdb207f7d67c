// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_run_directory_h
#define exemplar_run_directory_h

#include <exemplar/base/directory_lock.h>
#include <exemplar/run/frames/frame_formats.h>
#include <exemplar/run/output/run_files.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  /// Where a run writes, and what it writes: by their names and beginnings its files are known.
  class RunDirectory
  {
  public:
    /// Keeps a reference to `formats`, all that frames of an earlier run may have.
    explicit RunDirectory(std::filesystem::path           path,
                          const std::vector<FrameFormat> &formats = frame_formats());

    /// Make the directory, or clear it of what an earlier run has written, and keep all others out of
    /// it as long as this object lives. Throws UserError, with nothing changed, if a run is
    /// writing there already, if the directory is none, cannot be written or is not of a run, if
    /// something in it has the name of a run's file but is none, or if one of `input_files` would be
    /// cleared away.
    void
    take_for_new_run(const std::vector<std::filesystem::path> &input_files);

    /// The same for a run that goes on there. Nothing is cleared, and where there is no directory nothing
    /// happens: then there is no checkpoint, either.
    void
    take_for_resume(const std::vector<std::filesystem::path> &input_files);

    /// Remove frames and states that an earlier run has written of steps after this one, and what it had not
    /// finished when it was killed: a run that goes on from here need not write them again.
    void
    remove_frames_after(unsigned int step) const;

    /// Remove files that show all frames: a run that goes on writes its own at its end.
    void
    remove_animations() const;

    /// Remove surfaces of examples, of which an edited scene may have fewer.
    void
    remove_shapes() const;

    /// Of a process that writes into a directory which another one has taken.
    void
    watch();

    /// Do something in the directory that was taken, or is watched. Throws std::runtime_error if it has been
    /// removed or replaced before, or if that is why the action failed, for what stands there now may be
    /// another run's; what the action throws otherwise.
    void
    do_inside(const std::function<void()> &action) const;

    /// Why a file in this directory is none that a run has written, in words that follow "which"; empty
    /// if it is one, by its name and beginning.
    std::string
    objection_to(const std::string &name) const;

    /// Whether a run has written its parameters here.
    bool
    is_ours() const;

    const std::filesystem::path &
    get_path() const
    {
      return files.directory;
    }

    const RunFiles &
    get_files() const
    {
      return files;
    }

    /// The steps of which a state is kept, ascending.
    std::vector<unsigned int>
    kept_states() const;

    /// Copy the scene and the statistics of the steps so far to original_N.prm, parameters_N.prm and
    /// statistics_N.csv with the first free number N; returns the name of the scene's copy.
    std::string
    keep_earlier_scene() const;

    /// The first line of parameters.prm: by it a directory is known as ours.
    static const std::string mark;

    /// The first line of log.txt.
    static const std::string log_mark;

  private:
    /// What a file of this name begins with if a run has written it, or has left it when it was
    /// killed; nothing if no run writes such a file.
    std::optional<std::string>
    beginning_of(const std::string &name) const;

    /// The names in the directory that runs write.
    std::vector<std::string>
    own_names() const;

    void
    lock();

    void
    require_in_place() const;

    /// Throws UserError if one of the inputs is among the files of these names.
    void
    refuse_inputs(const std::vector<std::string>           &names,
                  const std::vector<std::filesystem::path> &input_files,
                  const std::string                        &what_would_happen) const;

    /// Throws UserError unless the directory is empty or of a run; `names` are own_names().
    void
    refuse_directory_of_others(const std::vector<std::string> &names) const;

    /// The beginning of the message that says so.
    std::string
    refusal_of(const std::string &name, const std::string &objection) const;

    void
    clear() const;

    RunFiles                             files;
    const std::vector<FrameFormat>      &formats;
    std::unique_ptr<const DirectoryLock> taken;   ///< null: it is not
    std::unique_ptr<const OpenDirectory> watched; ///< the same
  };
} // namespace Exemplar

#endif
