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
  /// The directory of a run, whose files are recognised by their names and beginnings.
  class RunDirectory
  {
  public:
    /// Keeps a reference to `formats`, all formats that frames of an earlier run may have.
    explicit RunDirectory(std::filesystem::path           path,
                          const std::vector<FrameFormat> &formats = frame_formats());

    /// Make the directory, or remove the files of an earlier run, and lock it for the lifetime of
    /// this object. Throws UserError, with nothing changed, if a run is writing there already, if
    /// it is no directory, is write-protected or not of a run, if some file has the name of a run's
    /// file but is none, or if one of `input_files` would be removed.
    void
    take_for_new_run(const std::vector<std::filesystem::path> &input_files);

    /// Lock the directory for a run that continues there; throws as take_for_new_run(). Nothing is
    /// removed, and if there is no directory, and so no checkpoint, nothing happens.
    void
    take_for_resume(const std::vector<std::filesystem::path> &input_files);

    /// Remove frames and states of steps after this one, and the temporary files of a killed run,
    /// which a run that continues need not write again.
    void
    remove_frames_after(unsigned int step) const;

    /// Remove the animations: a run that continues writes its own at its end.
    void
    remove_animations() const;

    /// Remove surfaces of examples: an edited scene may have fewer.
    void
    remove_shapes() const;

    /// Watch the directory, in a process that writes there while another process holds the lock.
    void
    watch();

    /// Run an action in the directory that is locked or watched. Throws std::runtime_error if it
    /// has been removed or replaced, before or during the action, as its files may be another
    /// run's; else passes on exceptions of the action.
    void
    do_inside(const std::function<void()> &action) const;

    /// Why a file in this directory cannot be one of a run, in words that follow "which"; empty if
    /// it is one, by its name and beginning.
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

    /// The steps of the kept states, ascending.
    std::vector<unsigned int>
    kept_states() const;

    /// Copy the scene and the statistics so far to original_N.prm, parameters_N.prm and
    /// statistics_N.csv with the first free number N; returns the name of the scene's copy.
    std::string
    keep_earlier_scene() const;

    /// The first line of parameters.prm, which marks directories of runs.
    static const std::string mark;

    /// The first line of log.txt.
    static const std::string log_mark;

  private:
    /// The beginning of files of this name if a run, even a killed one, has written them; nothing
    /// if runs write no such files.
    std::optional<std::string>
    beginning_of(const std::string &name) const;

    /// The names in the directory that belong to files of runs.
    std::vector<std::string>
    own_names() const;

    void
    lock();

    void
    require_in_place() const;

    /// Throws UserError if an input file has one of these names in the directory.
    void
    refuse_inputs(const std::vector<std::string>           &names,
                  const std::vector<std::filesystem::path> &input_files,
                  const std::string                        &what_would_happen) const;

    /// Throws UserError unless the directory is empty or of a run; `names` are own_names().
    void
    refuse_directory_of_others(const std::vector<std::string> &names) const;

    /// The beginning of the message of refuse_directory_of_others().
    std::string
    refusal_of(const std::string &name, const std::string &objection) const;

    void
    clear() const;

    RunFiles                             files;
    const std::vector<FrameFormat>      &formats;
    std::unique_ptr<const DirectoryLock> taken;   ///< lock of this process; null: none
    std::unique_ptr<const OpenDirectory> watched; ///< null: not watched
  };
} // namespace Exemplar

#endif
