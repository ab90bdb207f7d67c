// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_recording_h
#define exemplar_live_recording_h

#include <exemplar/exemplar.h>

#include <filesystem>

namespace Exemplar::Live
{
  /// A directory with a session on disk: session.txt, and scene.prm, which plays it again to the same bytes.
  class Recording
  {
  public:
    /// Throws UserError unless the directory is empty, can be made, or holds an earlier recording, which is replaced.
    Recording(std::filesystem::path directory, const SceneFile &scene, double step_size);

    /// What SessionLog writes.
    std::filesystem::path
    session_file() const
    {
      return directory / "session.txt";
    }

    /// The steps so far, for a scene that ends there.
    void
    save_scene(unsigned int n_steps);

    /// Write the pose of a problem as pose_NNNN.msh; returns the file.
    std::filesystem::path
    save_pose(const Problem &problem);

  private:
    const std::filesystem::path directory;
    const SceneFile            &scene;
    const double                step_size;
    unsigned int                n_poses = 0;
  };
} // namespace Exemplar::Live

#endif
