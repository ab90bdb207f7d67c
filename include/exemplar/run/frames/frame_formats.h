// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_frame_formats_h
#define exemplar_frame_formats_h

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  class FESpace;
  struct Frame;
  class FrameWriter;
  class Mesh;
  struct SurfaceMesh;

  /// How an animation is played.
  struct Playback
  {
    double interval          = 1.; ///< of time from frame to frame [s]; of t, where that is no time
    double frames_per_second = 24.;
    bool   z_is_up           = false; ///< else y
  };

  /// What frames show; it outlives their writers.
  struct FrameSubject
  {
    const Mesh        &mesh;
    const FESpace     &fe_space;
    const SurfaceMesh *surface; ///< in the file's unit; null unless a format shows it
    Playback           playback = {};
    std::string        carried  = {}; ///< name of the surface, if it is one of Mesh/Carry
  };

  /// A format that frames can be written in: its files and who writes them.
  struct FrameFormat
  {
    using MakeWriter = std::function<std::unique_ptr<const FrameWriter>(const FrameSubject &)>;

    /// Writes the file that joins the pieces of a frame, which have these names.
    using JoinPieces = std::function<void(const Frame                    &frame,
                                          const std::vector<std::string> &pieces,
                                          const std::filesystem::path    &file)>;

    std::string name;      ///< in Output/Formats, and what the names of frames end in
    std::string animation; ///< name of the file that shows all frames; empty: there is none
    MakeWriter  make_writer;

    /// What every frame and every animation begin with; empty: not known.
    std::string frame_beginning = {}, animation_beginning = {};

    bool shows_surface = false; ///< whether the writer needs the surface of the body

    /// Of a body that several processes share each writes a piece of the frame, and a file joins them:
    /// who writes that, what its name ends in, and what it begins with; null and empty: frames have
    /// no pieces.
    JoinPieces  join         = {};
    std::string joint_ending = {}, joint_beginning = {};

    /// Who writes a surface of Mesh/Carry; null: make_writer.
    MakeWriter make_carried_writer = {};

    bool
    has_pieces() const
    {
      return join != nullptr;
    }

    /// The writer of the body's frames, or those of a surface that it carries.
    std::unique_ptr<const FrameWriter>
    writer_of(const FrameSubject &subject) const;

    /// The name of a step's frame, without the directory, of the body or of the surface of Mesh/Carry
    /// that has this name.
    std::string
    frame_name(unsigned int step, const std::string &carried = "") const;

    /// The name of the file that shows all frames, likewise.
    std::string
    animation_name(const std::string &carried = "") const;

    /// The names of what so many processes write of a frame: that of the frame, or of a piece each.
    /// What a body carries has no pieces.
    std::vector<std::string>
    names_of_pieces(unsigned int       step,
                    unsigned int       n_processes,
                    const std::string &carried = "") const;

    /// The name of the file that joins these.
    std::string
    joint_name(unsigned int step) const;

    /// The step of the frame, or of the piece of one, of this name; nothing if no run writes such a frame.
    std::optional<unsigned int>
    step_of(const std::string &file) const;

    /// Whether a file of this name shows all frames, of the body or of what it carries.
    bool
    is_animation(const std::string &file) const;

    /// What a file of this name (without the directory) begins with if a run has written it;
    /// nothing if no run writes files of this name.
    std::optional<std::string>
    beginning_of(const std::string &file) const;
  };

  /// All formats.
  const std::vector<FrameFormat> &
  frame_formats();

  /// Of formats, as Output/Formats has them.
  std::vector<std::string>
  names_of(const std::vector<FrameFormat> &formats);
} // namespace Exemplar

#endif
