// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_recording_h
#define exemplar_live_recording_h

#include <exemplar/exemplar.h>
#include <exemplar/run/session/session.h>

#include <filesystem>
#include <fstream>

namespace Exemplar::Live
{
  /// A session on disk: session.txt, and scene.prm, which plays it again to the same bytes.
  class Recording
  {
  public:
    /// Throws UserError unless the directory is empty, can be made, or holds an earlier recording, which is replaced.
    Recording(std::filesystem::path directory, const SceneFile &scene, double step_size);

    /// Once more something was done.
    void
    add(const SessionEvent &event);

    /// The steps so far, for a scene that ends there.
    void
    save_scene(unsigned int n_steps);

    /// All is as if only this had been done.
    void
    replace(const Session &session, unsigned int n_steps);

    /// Write the pose of a problem as pose_NNNN.msh; returns the file.
    std::filesystem::path
    save_pose(const Problem &problem);

  private:
    /// Throws std::runtime_error if the disk has not taken all.
    void
    require_written(const std::ostream &out, const std::filesystem::path &file) const;

    const std::filesystem::path directory;
    const SceneFile            &scene;
    const double                step_size;
    std::ofstream               session;
    unsigned int                n_poses = 0;
  };
} // namespace Exemplar::Live

#endif
