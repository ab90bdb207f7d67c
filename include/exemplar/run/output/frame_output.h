// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_frame_output_h
#define exemplar_frame_output_h

#include <exemplar/base/background_writer.h>
#include <exemplar/obstacles/obstacle_picture.h>
#include <exemplar/run/frames/frame_formats.h>
#include <exemplar/run/frames/frame_writer.h>
#include <exemplar/run/output/run_directory.h>
#include <exemplar/run/problem/problem.h>
#include <exemplar/surface/skin/surface_skin.h>

#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

namespace Exemplar
{
  /// The state, as frames show it.
  Frame
  frame_of(Problem &problem);

  /// How a scene's frames are played.
  Playback
  playback_of(const SceneParameters &scene, const TimeAxis &axis);

  /// The frames of a run, in the formats of Output/Formats. With more than one thread they are
  /// written while the next step is computed; write() and drain() may then throw the error of
  /// an earlier frame.
  class FrameOutput
  {
  public:
    /// Keeps references to all three; `formats` are all that exist. Throws UserError if the scene
    /// asks for another one, or shows a surface that is not that of the body.
    FrameOutput(Problem                        &problem,
                const RunDirectory             &directory,
                const std::vector<FrameFormat> &formats);

    /// Whether a step has a frame: every Output/Every steps, and the last.
    bool
    is_due(unsigned int step) const;

    /// If a format shows the surface of the body, write it at rest, rest.obj, and in the poses of
    /// the examples, NAME.obj for each weight NAME of statistics.csv; for a weight of a region, the
    /// region alone is in the pose. Carried surfaces are written likewise, with their names
    /// appended.
    void
    write_shapes() const;

    /// Copy the changing data from the problem's state and have the frame written.
    void
    write(std::optional<SpaceError> space_error = {});

    /// Whether the frame of the present step is missing in a format.
    bool
    is_missing() const;

    /// Return when all frames are on disk.
    void
    drain();

    /// Write the animations, including frames of earlier parts of a resumed run. Call after
    /// drain().
    void
    write_animations() const;

    /// Remove a step's frame, in all formats.
    void
    remove(unsigned int step) const;

  private:
    using Writer = std::pair<const FrameFormat *, std::unique_ptr<const FrameWriter>>;

    /// An object with frames: the body, or a surface that it carries.
    struct Shown
    {
      std::string                        carried; ///< name of a carried surface; empty: the body
      std::filesystem::path              folder;  ///< of the surface's file
      const SurfaceMesh                 *surface; ///< null if no format shows the body's surface
      std::unique_ptr<const SurfaceSkin> skin;    ///< interpolates the surface; null likewise
      std::vector<Writer>                writers; ///< of the formats in use; empty without frames

      /// Whether these are the obstacles, which all processes know and one shows.
      bool
      are_obstacles() const
      {
        return carried == name_of_obstacles;
      }
    };

    Shown
    make_body() const;

    Shown
    make_carried(const CarriedSurface &carried) const;

    void
    add_writers(Shown &shown) const;

    /// The surface at rest and in the poses of the examples.
    void
    write_shapes_of(const Shown &shown) const;

    /// Displacements of the nodes from rest in the pose of weight i [m].
    Vector
    displacement_of_weight(unsigned int i) const;

    static void
    refuse_what_is_not_finite(const Frame &frame);

    /// Set the places of the surface's vertices, and their velocities if a format shows them.
    static void
    show_surface(const SurfaceSkin &skin, const std::vector<Writer> &writers, Frame &frame);

    /// Write the files of a frame; for a body that processes share, this process' piece.
    void
    write_files(Frame &frame) const;

    /// The file of a step's frame, or the one that joins its pieces.
    std::filesystem::path
    file_of(const FrameFormat &format, unsigned int step, const std::string &carried) const;

    /// The frames on disk, in order of time, of a body with the obstacles beside it.
    std::vector<WrittenFrame>
    written_frames(const FrameFormat &format, const std::string &carried) const;

    Problem                        &problem;
    const RunDirectory             &directory;
    const std::vector<FrameFormat> &formats;

    std::optional<ObstaclePicture> picture;    ///< of obstacles, if there are any
    std::vector<Shown>             all_shown;  ///< the body, carried surfaces, obstacles
    BackgroundWriter               background; ///< last, as its jobs use the others
  };
} // namespace Exemplar

#endif
