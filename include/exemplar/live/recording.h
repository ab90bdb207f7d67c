// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_recording_h
#define exemplar_live_recording_h

#include <exemplar/base/descriptor.h>
#include <exemplar/base/directory_lock.h>
#include <exemplar/exemplar.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace Exemplar::Live
{
  /// The input files of a scene, copied for a recording: files of the scene may be saved anew while
  /// a session lasts, and the recording must play with those that the session has read.
  class KeptInputs
  {
  public:
    /// Notes names and contents of the files, before they are read. Throws UserError for one that
    /// is no regular file, as it cannot be read again; a missing file is left to its reader.
    explicit KeptInputs(const SceneFile &scene);

    /// Copies them to inputs/ in a directory, each into a folder that is named by the content, so
    /// that later copies replace nothing; for a .geo, which may take in others, `mesh` is written
    /// that it gave. Returns the keys of the scene with the names of the copies, relative to the
    /// directory. To be called after all has been read. Throws UserError, with nothing left behind,
    /// if a file has changed meanwhile, or if a copy fails.
    std::vector<DeclaredKey>
    copy_to(const std::filesystem::path &directory, const MshFile &mesh) const;

  private:
    /// A key of the scene that names a file or a sequence of files.
    struct Named
    {
      std::string                        key; ///< its path
      std::string                        name;
      std::vector<std::filesystem::path> files;
      std::string                        digest; ///< digest of all files
    };

    std::vector<DeclaredKey> keys;
    std::vector<Named>       all; ///< keys whose files exist
  };

  /// A directory with a session on disk: session.txt, scene.prm, which plays it again to the same
  /// bytes, and copies of the scene's inputs. An earlier session in it is kept as session_NNNN.txt
  /// and scene_NNNN.prm.
  class Recording
  {
  public:
    /// Checks the directory and changes nothing. Throws UserError unless it can be made, is empty
    /// but for meshes, or holds an earlier recording.
    Recording(std::filesystem::path directory, double step_size);

    /// Makes the directory and keeps other servers out of it. To be called before all that follows.
    /// Throws UserError if another one records there.
    void
    take();

    const std::filesystem::path &
    get_directory() const
    {
      return directory;
    }

    /// The file that SessionLog writes.
    std::filesystem::path
    session_file() const
    {
      return directory / "session.txt";
    }

    /// Keeps what is recorded so far under names of its own; returns the scene that plays it, or an
    /// empty path if nothing was done. SessionLog is to begin a new file after this, and
    /// save_scene() to be called.
    std::filesystem::path
    set_aside();

    /// Writes the scene, with no steps yet. `keys` are those of the scene that is simulated.
    void
    save_scene(std::vector<DeclaredKey> keys);

    /// Sets the number of steps that the scene plays.
    void
    set_n_steps(unsigned int n_steps);

    /// Write the pose of a problem as pose_NNNN.msh; returns the file.
    std::filesystem::path
    save_pose(const Problem &problem);

  private:
    std::filesystem::path
    scene_file() const
    {
      return directory / "scene.prm";
    }

    const std::filesystem::path  directory;
    const double                 step_size;
    std::optional<DirectoryLock> lock; ///< lock of the directory
    unsigned int                 n_poses = 0;
    std::unique_ptr<Descriptor>  scene;            ///< scene.prm, open
    std::size_t                  place_of_end = 0; ///< offset of the value of Time/End [bytes]
  };
} // namespace Exemplar::Live

#endif
