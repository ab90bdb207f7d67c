// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_frame_output_h
#define exemplar_frame_output_h

#include <exemplar/base/background_writer.h>
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

  /// The frames of a run, in the formats of Output/Formats. With more than one thread they are
  /// written while the next step is computed; write() and drain() may then throw the error of
  /// an earlier frame.
  class FrameOutput
  {
  public:
    /// Keeps references to all three; `formats` are all that there are. Throws UserError
    /// if the scene asks for another one, or shows a surface that is not that of the body.
    FrameOutput(Problem                        &problem,
                const RunDirectory             &directory,
                const std::vector<FrameFormat> &formats);

    /// Whether a step has a frame: every so many steps, and the last.
    bool
    is_due(unsigned int step) const;

    /// Where a format shows the surface of the body, write it at rest, rest.obj, and as it is in the
    /// poses of the examples, NAME.obj for each weight NAME of statistics.csv; of weights of a region
    /// only the region is in the pose. What the body carries likewise, with its name behind.
    void
    write_shapes() const;

    /// Take what the next step changes from the problem's state and have it written.
    void
    write(std::optional<SpaceError> space_error = {});

    /// Whether a format lacks the frame of the present step.
    bool
    is_missing() const;

    /// Return when all frames are on disk.
    void
    drain();

    /// Write the files that show all frames, also those that an earlier part of a resumed run
    /// has left. To be called after drain().
    void
    write_animations() const;

    /// Remove a step's frame, in whatever format.
    void
    remove(unsigned int step) const;

  private:
    Playback
    playback() const;

    using Writer = std::pair<const FrameFormat *, std::unique_ptr<const FrameWriter>>;

    /// What has frames: the body, or a surface that it carries.
    struct Shown
    {
      std::string                        carried; ///< its name; empty: the body
      const SurfaceMesh                 *surface; ///< null if no format shows that of the body
      std::unique_ptr<const SurfaceSkin> skin;    ///< that carries it; null likewise
      std::vector<Writer>                writers; ///< of the formats in use; empty without frames
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

    /// How far nodes have moved in the pose of weight i [m].
    Vector
    displacement_of_weight(unsigned int i) const;

    static void
    refuse_what_is_not_finite(const Frame &frame);

    /// The files of a frame; of a body that processes share, this one's piece.
    void
    write_files(Frame &frame) const;

    /// The frame of a step, or what joins its pieces.
    std::filesystem::path
    file_of(const FrameFormat &format, unsigned int step, const std::string &carried) const;

    /// The frames on disk, in order of time.
    std::vector<WrittenFrame>
    written_frames(const FrameFormat &format, const std::string &carried) const;

    Problem                        &problem;
    const RunDirectory             &directory;
    const std::vector<FrameFormat> &formats;

    std::vector<Shown> all_shown;  ///< the body, then what it carries
    BackgroundWriter   background; ///< last, as its jobs use the others
  };
} // namespace Exemplar

#endif
